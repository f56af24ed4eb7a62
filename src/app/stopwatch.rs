//! Timings of the phases, and a progress bar when work is long and somebody looks.

use std::{
    io::IsTerminal,
    sync::{
        Arc, Condvar, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicUsize, Ordering::Relaxed},
    },
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;

use crate::base::{Phase, Watch};

/// Work shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);

/// How often the bar is drawn anew.
const REDRAW: Duration = Duration::from_millis(100);

/// Measures phases by the wall clock.
#[derive(Debug)]
pub struct Stopwatch {
    started: Instant,
    laps: Mutex<Laps>,
    steps: Arc<Steps>,
    bar: Mutex<Option<JoinHandle<()>>>,
}

#[derive(Debug)]
struct Laps {
    /// The phases entered and not left, the innermost last.
    open: Vec<Phase>,
    /// When the innermost phase began or went on.
    since: Instant,
    /// Time spent, by the order of [`Phase`].
    spent: [Duration; 6],
}

#[derive(Debug, Default)]
struct Steps {
    expected: AtomicUsize,
    done: AtomicUsize,
    /// The last stage that began.
    stage: Mutex<&'static str>,
    over: Mutex<bool>,
    bell: Condvar,
}

impl Stopwatch {
    /// Starts now. A bar will show if standard error is a terminal.
    pub fn start() -> Stopwatch {
        let started = now();
        let laps = Laps { open: vec![], since: started, spent: [Duration::ZERO; 6] };
        let steps = Arc::new(Steps::default());
        let bar = std::io::stderr().is_terminal().then(|| {
            let steps = steps.clone();
            thread::spawn(move || steps.draw())
        });
        Stopwatch { started, laps: Mutex::new(laps), steps, bar: Mutex::new(bar) }
    }

    /// Takes the bar away; what is printed after this stands on clean lines.
    pub fn end_bar(&self) {
        *hold(&self.steps.over) = true;
        self.steps.bell.notify_all();
        if let Some(bar) = hold(&self.bar).take() {
            let _ = bar.join();
        }
    }

    /// The milliseconds of each phase and in total, as JSON.
    pub fn timings(&self) -> String {
        let spent = hold(&self.laps).spent;
        let ms = |time: Duration| (time.as_secs_f64() * 1e6).round() / 1e3;
        let of = |phase: Phase| ms(spent[phase as usize]);
        let object = json!({
            "parse_ms": of(Phase::Parse),
            "eval_ms": of(Phase::Eval),
            "solids_ms": of(Phase::Solids),
            "drawings_ms": of(Phase::Drawings),
            "halftones_ms": of(Phase::Halftones),
            "write_ms": of(Phase::Write),
            "total_ms": ms(self.started.elapsed()),
        });
        format!("{object:#}\n")
    }
}

impl Drop for Stopwatch {
    fn drop(&mut self) {
        self.end_bar();
    }
}

impl Watch for Stopwatch {
    fn enter(&self, phase: Phase) {
        let mut laps = hold(&self.laps);
        laps.charge();
        laps.open.push(phase);
    }

    fn leave(&self) {
        let mut laps = hold(&self.laps);
        laps.charge();
        laps.open.pop();
    }

    fn expect(&self, steps: usize) {
        self.steps.expected.fetch_add(steps, Relaxed);
    }

    fn step(&self) {
        self.steps.done.fetch_add(1, Relaxed);
    }

    fn stage(&self, name: &'static str) {
        *hold(&self.steps.stage) = name;
    }
}

impl Laps {
    /// Books the time since the last change on the innermost phase.
    fn charge(&mut self) {
        let time = now();
        if let Some(&phase) = self.open.last() {
            self.spent[phase as usize] += time - self.since;
        }
        self.since = time;
    }
}

impl Steps {
    /// Runs on a thread of its own: waits, then draws until the work is over.
    fn draw(&self) {
        let mut bar = None;
        let mut patience = PATIENCE;
        let mut over = hold(&self.over);
        while !*over {
            let waited = self.bell.wait_timeout(over, patience);
            over = waited.unwrap_or_else(PoisonError::into_inner).0;
            if *over {
                break;
            }
            patience = REDRAW;
            let bar = bar.get_or_insert_with(new_bar);
            bar.set_length(self.expected.load(Relaxed) as u64);
            bar.set_position(self.done.load(Relaxed) as u64);
            bar.set_message(*hold(&self.stage));
            bar.tick();
        }
        if let Some(bar) = bar {
            bar.finish_and_clear();
        }
    }
}

fn new_bar() -> ProgressBar {
    let style =
        ProgressStyle::with_template("{spinner} {wide_bar} {pos}/{len} solids {msg} {elapsed}");
    let bar = ProgressBar::new(0).with_elapsed(PATIENCE);
    style.map(|style| bar.clone().with_style(style)).unwrap_or(bar)
}

#[expect(clippy::disallowed_methods, reason = "the application may look at the clock")]
fn now() -> Instant {
    Instant::now()
}

fn hold<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inner_phase_pauses_the_outer_one() {
        let watch = Stopwatch::start();
        watch.enter(Phase::Eval);
        watch.enter(Phase::Solids);
        thread::sleep(Duration::from_millis(20));
        watch.leave();
        watch.leave();
        let times: serde_json::Value = serde_json::from_str(&watch.timings()).expect("JSON");
        assert!(times["solids_ms"].as_f64() >= Some(20.0));
        assert!(times["eval_ms"].as_f64() < Some(10.0));
        assert!(times["total_ms"].as_f64() >= times["solids_ms"].as_f64());
    }
}
