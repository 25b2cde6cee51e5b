//! The inputs that an image of a pass was drawn from.

use std::any::Any;
use std::sync::{Arc, Weak};

/// Everything that an image of a pass depends on.
#[derive(Clone, Default)]
pub(super) struct PassCacheKey {
    /// The device objects. A weak reference keeps the address, so that no other object gets it.
    pub(super) objects: Vec<Weak<dyn Any + Send + Sync>>,
    /// When the images of other passes were drawn; `None`: not at all.
    pub(super) images: Vec<Option<u64>>,
    /// The parts of uniform blocks that the stages use.
    pub(super) bytes: Vec<u8>,
}

impl PassCacheKey {
    /// Adds a device object.
    pub(super) fn object<T: Any + Send + Sync>(&mut self, object: &Arc<T>) {
        let object: Weak<dyn Any + Send + Sync> = Arc::downgrade(object) as _;
        self.objects.push(object);
    }
}

impl PartialEq for PassCacheKey {
    fn eq(&self, other: &Self) -> bool {
        let addresses = |from: &Self| -> Vec<*const ()> { from.objects.iter().map(|o| o.as_ptr().cast()).collect() };
        self.images == other.images && self.bytes == other.bytes && addresses(self) == addresses(other)
    }
}
