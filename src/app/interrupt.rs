//! What is half written is taken away when the command is told to stop (Ctrl-C, a closed terminal, a
//! polite kill).
//!
//! While nothing is being written, a signal ends the command at once; while a file is, the signal is noted,
//! and the writer asks for it. So no thread has to wait for signals, which would take longer to start than
//! most files to write.

use std::{
    process,
    sync::{
        Mutex, Once, PoisonError,
        atomic::{AtomicBool, Ordering::SeqCst},
    },
};

#[cfg(unix)]
use signal_hook::consts::SIGHUP;
use signal_hook::{
    consts::{SIGINT, SIGTERM},
    flag,
};

/// The exit code of a command that was told to stop: 128 and the number of SIGINT, as shells have it.
const INTERRUPTED: i32 = 130;

const SIGNALS: &[i32] = &[
    SIGINT,
    SIGTERM,
    #[cfg(unix)]
    SIGHUP,
];

/// Held while a file is written.
static WRITING: Mutex<()> = Mutex::new(());
static LISTENING: Once = Once::new();
/// Whether nothing is being written.
static IS_IDLE: AtomicBool = AtomicBool::new(true);
/// Whether the command was told to stop.
static IS_TOLD: AtomicBool = AtomicBool::new(false);

/// Writes a file, one at a time. `write` is given the question whether to stop and leave nothing behind; if so,
/// the process ends after it.
pub fn writing<T>(write: impl FnOnce(&dyn Fn() -> bool) -> T) -> T {
    let _alone = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    LISTENING.call_once(listen);
    IS_IDLE.store(false, SeqCst);
    let done = write(&|| IS_TOLD.load(SeqCst));
    IS_IDLE.store(true, SeqCst);
    if IS_TOLD.load(SeqCst) {
        process::exit(INTERRUPTED);
    }
    done
}

/// Lets signals be noted, and then end the command if nothing is being written. In this order: either they see
/// that, or who writes sees the note.
fn listen() {
    for &signal in SIGNALS {
        // Without a handler the file stays behind; it is no reason not to write.
        let _ = flag::register(signal, &IS_TOLD);
        let _ = flag::register_conditional_shutdown(signal, INTERRUPTED, &IS_IDLE);
    }
}
