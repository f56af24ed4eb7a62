//! What is half written is taken away when the command is told to stop (Ctrl-C, a closed terminal, a
//! polite kill).

use std::{
    fs,
    path::PathBuf,
    process,
    sync::{Mutex, MutexGuard, Once, PoisonError},
};

/// The exit code of a command that was told to stop: 128 and the number of SIGINT, as shells have it.
const INTERRUPTED: i32 = 130;

/// The temporary file being written.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);
static LISTENING: Once = Once::new();

/// The record of the temporary file being written. While it is held the command does not stop, so
/// create and rename while holding it.
pub fn unfinished() -> MutexGuard<'static, Option<PathBuf>> {
    LISTENING.call_once(|| {
        // Without a handler the file stays behind; it is no reason not to write.
        let _ = ctrlc::set_handler(stop);
    });
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends the process; runs on a thread of its own.
fn stop() {
    let file = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(path) = &*file {
        let _ = fs::remove_file(path);
    }
    process::exit(INTERRUPTED);
}
