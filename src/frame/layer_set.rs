//! Some of the layers.

/// A set of layers: there are fewer than 32.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct LayerSet(u32);

impl LayerSet {
    pub(crate) fn insert(&mut self, layer: usize) {
        self.0 |= 1 << layer;
    }

    pub(crate) fn contains(self, layer: usize) -> bool {
        self.0 >> layer & 1 == 1
    }

    pub(crate) fn len(self) -> u32 {
        self.0.count_ones()
    }

    pub(crate) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The layers, the lowest first.
    pub(crate) fn iter(self) -> impl Iterator<Item = usize> {
        (0..32).filter(move |&layer| self.contains(layer))
    }
}
