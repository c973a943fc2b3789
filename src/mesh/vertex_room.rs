//! Room for the vertices of a mesh, which all threads take from.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::limits::{Excess, Limits, Quantity};

/// Counts vertices against their limit.
pub(crate) struct VertexRoom {
    limits: Limits,
    taken: AtomicUsize,
}

impl VertexRoom {
    pub(crate) fn new(limits: Limits) -> Self {
        let taken = AtomicUsize::new(0);
        Self { limits, taken }
    }

    pub(crate) fn take(&self, vertices: usize) {
        self.taken.fetch_add(vertices, Ordering::Relaxed);
    }

    /// Whether more was taken than there is: what is made now is made in vain.
    pub(crate) fn is_full(&self) -> bool {
        self.check().is_err()
    }

    pub(crate) fn check(&self) -> Result<(), Excess> {
        let taken = self.taken.load(Ordering::Relaxed);
        self.limits.check(Quantity::MeshVertices, taken)
    }
}
