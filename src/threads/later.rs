//! A value that a thread makes while the window goes on.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

use crate::message::catch_panic;

/// A value that a thread of its own makes.
pub(crate) struct Later<T>(Receiver<Result<T, String>>);

impl<T: Send + 'static> Later<T> {
    /// Starts to make a value on a thread with this name. Dropping the result does not end the thread.
    pub(crate) fn start(name: &str, make: impl FnOnce() -> T + Send + 'static) -> Self {
        let (sender, receiver) = channel();
        let work = move || drop(sender.send(catch_panic(make)));
        // Without a thread the sender is gone, as below.
        let _ = std::thread::Builder::new().name(name.to_owned()).spawn(work);
        Self(receiver)
    }

    /// The value, once it is made; or why it was not.
    pub(crate) fn get(&self) -> Option<Result<T, String>> {
        match self.0.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err("the system has no more threads".to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wait<T: Send + 'static>(later: &Later<T>) -> Result<T, String> {
        loop {
            match later.get() {
                Some(result) => return result,
                None => std::thread::yield_now(),
            }
        }
    }

    #[test]
    fn a_value_comes_once_it_is_made_and_a_panic_is_told() {
        let (go, may_go) = channel();
        let later = Later::start("made", move || may_go.recv().map_or(0, |number: u32| number + 1));
        assert_eq!(later.get(), None);
        go.send(7).unwrap();
        assert_eq!(wait(&later), Ok(8));
        assert_eq!(wait(&Later::start("fails", || -> u32 { panic!("no row") })), Err("no row".to_owned()));
    }
}
