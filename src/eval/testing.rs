//! Running the tests of a file.

use std::sync::Arc;

use super::{
    evaluator::Evaluator,
    failure::{Failure, Outcome},
    instance::InstanceId,
    unit::TestCode,
};
use crate::{
    base::{Code, Diagnostic, Span},
    shape::ShapeId,
};

/// A test of a file.
#[derive(Clone, PartialEq, Debug)]
pub struct TestInfo {
    /// Its title.
    pub title: String,
    /// Its place.
    pub span: Span,
}

/// What came of a test.
#[derive(Clone, PartialEq, Debug)]
pub struct TestOutcome {
    /// Whether it passed.
    pub passed: bool,
    /// Why not, and warnings.
    pub diagnostics: Vec<Diagnostic>,
    /// References to be written, when the test ran with `update`.
    pub writes: Vec<Write>,
}

/// A reference that is new or has changed.
#[derive(Clone, PartialEq, Debug)]
pub enum Write {
    /// A text.
    Text {
        /// Path relative to the project root.
        path: Arc<str>,
        /// Its content.
        text: String,
    },
    /// A mesh of a shape, in the format that the path's ending names.
    Mesh {
        /// Path relative to the project root.
        path: Arc<str>,
        /// What it holds.
        shape: ShapeId,
    },
}

/// A test that is running.
#[derive(Debug)]
pub struct Running {
    /// Whether it is meant to fail.
    pub fails: bool,
    pub update: bool,
    pub writes: Vec<Write>,
}

impl Evaluator<'_> {
    /// The tests in source order.
    pub fn tests(&mut self, instance: InstanceId) -> Vec<TestInfo> {
        let unit = self.instances[instance.0 as usize].unit.clone();
        let info = |test: &TestCode| {
            let title = self.eval_in(instance, test.title, test.frame);
            TestInfo { title: title.map_or("?".into(), |title| title.to_string()), span: test.span }
        };
        unit.tests.iter().map(info).collect()
    }

    /// Runs one test. With `update`, references that differ are given back to be written in place of
    /// failing the test.
    pub fn run_test(&mut self, instance: InstanceId, index: usize, update: bool) -> TestOutcome {
        self.steps_taken = 0;
        let before = std::mem::take(&mut self.messages);
        let unit = self.instances[instance.0 as usize].unit.clone();
        let result = match unit.tests.get(index) {
            Some(test) => self.test_result(instance, test, update),
            None => Err(Failure::TOLD),
        };
        let writes = self.test.take().map_or(vec![], |running| running.writes);
        if let Err(failure) = &result {
            self.report(failure);
        }
        let diagnostics = std::mem::replace(&mut self.messages, before).list;
        TestOutcome { passed: result.is_ok(), diagnostics, writes }
    }

    fn test_result(&mut self, instance: InstanceId, test: &TestCode, update: bool) -> Outcome<()> {
        if let Some(refused) = self.instances[instance.0 as usize].refused.clone() {
            return Err(refused);
        }
        let unit = self.instances[instance.0 as usize].unit.clone();
        let expected = match test.fails {
            Some(fails) => Some(self.eval_in(instance, fails, test.frame)?.to_string()),
            None => None,
        };
        self.test = Some(Running { fails: expected.is_some(), update, writes: vec![] });
        let result = self.eval_in(instance, test.body, test.frame);
        let span = test.fails.map_or(test.span, |fails| unit.span(fails));
        match (expected, result) {
            (None, result) => result.map(|_| ()),
            (Some(expected), Ok(_)) => {
                let message = format!("this test passes, but should fail with {expected:?}");
                Err(Diagnostic::error(Code::TestFailed, message).label(span, "").into())
            }
            (Some(expected), Err(failure)) => match failure.diagnostic() {
                Some(found) if found.message.contains(&expected) => Ok(()),
                Some(found) => {
                    let message = format!("this test fails, but not with {expected:?}");
                    let mut error = Diagnostic::error(Code::TestFailed, message).label(span, "");
                    error.labels.extend(found.labels.iter().cloned());
                    Err(error.note(format!("it fails with {:?}", found.message)).into())
                }
                None => Err(failure),
            },
        }
    }
}
