//! What is drawn in turn: the same view of the same regions, by several techniques or with several settings.

use crate::{scene::Scene, settings::Settings, technique::TechniqueName};

/// One after the other, again and again.
#[derive(Clone, Debug)]
pub struct Heat {
    pub entries: Vec<Entry>,
}

/// One that takes part.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Of the same camera and regions as all others.
    pub scene: Scene,
    pub settings: Settings,
    pub technique: TechniqueName,
    pub variant: Option<Variant>,
}

/// What a sweep has set.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// What it is called in the rows.
    pub sweep: &'static str,
    pub value: String,
    /// Whether this is what is used where nothing is set.
    pub is_default: bool,
}

impl Heat {
    /// A scene by all techniques. The bare globe is the first: the extra is over it.
    pub fn of_techniques(scene: &Scene, settings: Settings, names: &[TechniqueName]) -> Self {
        let others = names
            .iter()
            .copied()
            .filter(|&name| name != TechniqueName::Globe);
        let entry = |technique| Entry {
            scene: scene.clone(),
            settings,
            technique,
            variant: None,
        };
        Self {
            entries: [TechniqueName::Globe]
                .into_iter()
                .chain(others)
                .map(entry)
                .collect(),
        }
    }
}
