//! A resource that stays in use while its successor fails or is being made.

use std::sync::Arc;

/// The last good resource with its key, and the key of the last failure.
pub(super) struct LastGood<K, T> {
    pub(super) made: Option<(K, Arc<T>)>,
    failed: Option<K>,
    /// The resource of a state without a key, and the fallback after a failure before the first success.
    pub(super) none: Arc<T>,
}

impl<K: PartialEq, T> LastGood<K, T> {
    pub(super) fn new(none: Arc<T>) -> Self {
        Self { made: None, failed: None, none }
    }

    /// The resource of `key`, or the last good one if `key` has failed. `None` if `key` has not been tried yet.
    pub(super) fn get(&self, key: Option<&K>) -> Option<&Arc<T>> {
        let Some(key) = key else { return Some(&self.none) };
        match &self.made {
            Some((made, resource)) if made == key => Some(resource),
            _ if self.failed.as_ref() == Some(key) => Some(self.last_good()),
            _ => None,
        }
    }

    pub(super) fn last_good(&self) -> &Arc<T> {
        self.made.as_ref().map_or(&self.none, |(_, resource)| resource)
    }

    /// The last good resource, if it differs from the requested one only by an edit.
    pub(super) fn before_edit(&self, is_edit: impl Fn(&K) -> bool) -> Option<&Arc<T>> {
        self.made.as_ref().filter(|(key, _)| is_edit(key)).map(|(_, resource)| resource)
    }

    pub(super) fn set(&mut self, key: K, resource: Option<Arc<T>>) {
        match resource {
            Some(resource) => (self.made, self.failed) = (Some((key, resource)), None),
            None => self.failed = Some(key),
        }
    }
}

impl<K: Clone, T> Clone for LastGood<K, T> {
    fn clone(&self) -> Self {
        Self { made: self.made.clone(), failed: self.failed.clone(), none: self.none.clone() }
    }
}
