//! Which of several objects something was made of.

use std::any::Any;
use std::sync::{Arc, Weak};

/// The object behind an `Arc`; none by default. Equal ones are the same object, not objects of equal contents. It does not keep the object, but
/// its place in memory: an address alone would take a later object in the place of one that is gone for that one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Identity {
    address: usize,
    place: Option<Weak<dyn Any + Send + Sync>>,
}

impl Identity {
    pub(crate) fn of<T: Any + Send + Sync>(object: &Arc<T>) -> Self {
        let place: Weak<dyn Any + Send + Sync> = Arc::downgrade(&(object.clone() as Arc<dyn Any + Send + Sync>));
        Self { address: Arc::as_ptr(object) as usize, place: Some(place) }
    }

    pub(crate) fn of_any<T: Any + Send + Sync>(object: Option<&Arc<T>>) -> Self {
        object.map(Self::of).unwrap_or_default()
    }
}

impl PartialEq for Identity {
    fn eq(&self, other: &Self) -> bool {
        (self.address, self.place.is_some()) == (other.address, other.place.is_some())
    }
}

impl Eq for Identity {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_later_object_is_another_one_although_its_place_may_be_free() {
        let object = Arc::new([0_u8; 64]);
        let identity = Identity::of(&object);
        assert!(identity == Identity::of(&object.clone()) && identity != Identity::default());
        assert!(Identity::default() == Identity::of_any::<u8>(None));
        drop(object);
        for _ in 0..1000 {
            assert!(Identity::of(&Arc::new([0_u8; 64])) != identity);
        }
    }
}
