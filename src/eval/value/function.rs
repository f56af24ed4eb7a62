//! Functions as values.

use std::sync::Arc;

use super::{Value, meter, store::drop_flat};
use crate::eval::{
    instance::InstanceId,
    unit::{FunctionCode, Unit},
};

/// Something that can be called.
#[derive(Debug)]
pub enum Function {
    /// One signature: a lambda or a function of the modeller's.
    Closure(Closure),
    /// Several signatures under one name: a function of the library.
    Overloads {
        /// Its name.
        name: Arc<str>,
        /// The signatures in the order they are tried.
        signatures: Vec<Closure>,
    },
}

/// Code together with the values it took from around it.
#[derive(Debug)]
pub struct Closure {
    pub(in crate::eval) unit: Arc<Unit>,
    pub(in crate::eval) instance: InstanceId,
    pub(in crate::eval) code: Arc<FunctionCode>,
    captures: Vec<Value>,
}

impl Closure {
    pub(in crate::eval) fn new(
        unit: Arc<Unit>,
        instance: InstanceId,
        code: Arc<FunctionCode>,
        captures: Vec<Value>,
    ) -> Closure {
        meter::take(captures.len() + 1);
        Closure { unit, instance, code, captures }
    }

    pub(in crate::eval) fn captures(&self) -> &[Value] {
        &self.captures
    }

    pub(super) fn take_captures(&mut self) -> Vec<Value> {
        meter::give_back(self.captures.len());
        std::mem::take(&mut self.captures)
    }
}

impl Drop for Closure {
    fn drop(&mut self) {
        meter::give_back(self.captures.len() + 1);
        drop_flat(self.captures.drain(..));
    }
}

impl Function {
    /// Its name; `None` for a lambda.
    pub fn name(&self) -> Option<&str> {
        match self {
            Function::Closure(closure) => closure.code.name.as_deref(),
            Function::Overloads { name, .. } => Some(name),
        }
    }

    /// The signatures, in the order they are tried.
    pub(in crate::eval) fn signatures(&self) -> &[Closure] {
        match self {
            Function::Closure(closure) => std::slice::from_ref(closure),
            Function::Overloads { signatures, .. } => signatures,
        }
    }
}
