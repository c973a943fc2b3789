//! How a frame is counted: in planes whose sums are proven to be exact.

use super::{Renderer, prepare::Selected};
use crate::{
    error::RendererError,
    frame::code::{PlaneSums, joined_number},
    frame::layers::Counting,
    frame::mixture::Burden,
    options::{CountTechnique, Frame},
};

/// How a frame is counted.
pub(super) struct Chosen {
    pub(super) counting: Counting,
    /// By layer of ids: bits of checks in their plane.
    pub(super) joined: Vec<u32>,
    /// Uploaded for the tables of its layers.
    pub(super) table_bytes: u64,
    /// Units of weight per optical depth.
    pub(super) mixture_scale: f64,
}

impl Renderer {
    /// How this frame is counted and what it shows: with more planes, or by stencil, where what is drawn
    /// leaves no head-room for winding sums.
    pub(super) fn choose_layers(
        &mut self,
        frame: &Frame,
    ) -> Result<(Chosen, Vec<Selected>), RendererError> {
        let mut counting = match self.options.count {
            CountTechnique::Winding => Counting::Winding,
            CountTechnique::Stencil => Counting::Stencil,
        };
        let mut table_bytes = 0;
        loop {
            if self.layers[counting as usize].is_none() {
                let tables = self.make_layers(counting);
                table_bytes += tables.as_ref().map_or(0, |tables| tables.bytes);
                self.layers[counting as usize] = Some(tables);
            }
            let selections = self.select(frame, counting)?;
            if self.has_head_room(&selections, counting)?
                && let Some(mixture_scale) = self.mixture_scale(&selections, counting)?
            {
                let chosen = Chosen {
                    joined: self.joined(&selections, counting)?,
                    counting,
                    table_bytes,
                    mixture_scale,
                };
                return Ok((chosen, selections));
            }
            counting = match counting {
                Counting::Winding => Counting::SpareWinding,
                // That always has room.
                Counting::SpareWinding | Counting::Stencil => Counting::Stencil,
            };
        }
    }

    /// Units of weight per optical depth in the frame's mixture, or any number where there is none; nothing if
    /// sums would not be exact.
    fn mixture_scale(
        &self,
        selections: &[Selected],
        counting: Counting,
    ) -> Result<Option<f64>, RendererError> {
        let tables = self.layers(counting)?;
        let Some(mixture) = &tables.layering.mixture else {
            return Ok(Some(1.0));
        };
        let mut burden = Burden::default();
        for Selected {
            id,
            level,
            sight,
            selection,
        } in selections
        {
            let mesh = self.meshes[id].level(*level);
            let draws = &selection.layers[tables.layering.layers.len()];
            burden.add_draws(draws, mesh, sight, |left, right| {
                mixture.difference(left, right)
            });
        }
        Ok(tables.mixture_scale(mixture, &burden))
    }

    /// With how many bits of checks the sums of each layer of ids are proven to fit into one plane.
    fn joined(
        &self,
        selections: &[Selected],
        counting: Counting,
    ) -> Result<Vec<u32>, RendererError> {
        let tables = self.layers(counting)?;
        let most = |layer: usize, bits: u32| {
            let mut burden = Burden::default();
            for selected in selections {
                let mesh = self.meshes[&selected.id].level(selected.level);
                let draws = &selected.selection.layers[layer];
                burden.add_draws(draws, mesh, &selected.sight, |left, right| {
                    let [left, right] = [left, right].map(|code| joined_number(code, bits));
                    left.abs_diff(right).into()
                });
            }
            burden.most().1
        };
        let layers = 0..tables.layering.layers.len();
        Ok(layers
            .map(|layer| tables.joined(layer, |bits| most(layer, bits)))
            .collect())
    }

    /// Whether the sums of this frame are proven exact.
    fn has_head_room(
        &self,
        selections: &[Selected],
        counting: Counting,
    ) -> Result<bool, RendererError> {
        let layers = self.layers(counting)?;
        let drawn: Vec<PlaneSums> = (0..layers.layering.layers.len())
            .map(|layer| {
                let mut sums = PlaneSums::default();
                for selected in selections {
                    let mesh = self.meshes[&selected.id].level(selected.level);
                    selected.selection.layers[layer].add_sums(mesh, &mut sums);
                }
                sums
            })
            .collect();
        Ok(layers.leave_room_for(&drawn))
    }
}
