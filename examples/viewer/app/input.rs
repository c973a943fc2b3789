//! What a person does to the globe: mouse, wheel, touch pad, touch screen, keyboard.

use glam::DVec2;
use winit::{
    event::{ElementState, MouseButton, MouseScrollDelta, Touch, TouchPhase, WindowEvent},
    keyboard::{Key as WinitKey, NamedKey},
};

use super::App;
use crate::viewer::{Button, Key};

/// A touch pad's pixels for one step of a wheel.
const PX_PER_STEP: f64 = 60.0;
/// Of the zoom, for e times the size.
const STEPS_PER_E: f64 = 4.0;
/// Browsers tell of a pinch to e times the size as a wheel of so many pixels with the control key.
const PINCH_PX_PER_E: f64 = 100.0;

impl App {
    /// Takes what no panel wants.
    pub(super) fn input(&mut self, event: &WindowEvent) {
        let now_s = self.now_s();
        let viewer = &mut self.viewer;
        match event {
            WindowEvent::CursorMoved { position, .. } => {
                viewer.point(DVec2::new(position.x, position.y), now_s);
            }
            WindowEvent::CursorLeft { .. } => viewer.leave(),
            WindowEvent::MouseInput {
                state: ElementState::Pressed,
                button,
                ..
            } => {
                let tilts = self.ctrl || *button != MouseButton::Left;
                let button = if tilts { Button::Tilt } else { Button::Grab };
                if let Some(px) = viewer.pointer_px {
                    viewer.press(button, px, now_s);
                }
            }
            WindowEvent::MouseWheel { delta, .. } => viewer.scroll(match delta {
                MouseScrollDelta::LineDelta(_, lines) => f64::from(*lines),
                MouseScrollDelta::PixelDelta(px) if self.ctrl => {
                    px.y * (STEPS_PER_E / PINCH_PX_PER_E)
                }
                MouseScrollDelta::PixelDelta(px) => px.y / PX_PER_STEP,
            }),
            // By a share of the size.
            WindowEvent::PinchGesture { delta, .. } => {
                viewer.scroll(STEPS_PER_E * delta.max(-0.9).ln_1p());
            }
            WindowEvent::RotationGesture { delta, .. } => viewer.orbit.turn(f64::from(*delta), 0.0),
            WindowEvent::KeyboardInput { event, .. } if event.state.is_pressed() => {
                if let Some(key) = key(&event.logical_key) {
                    viewer.key(key);
                }
            }
            WindowEvent::Touch(touch) => self.touch(touch),
            _ => {}
        }
    }

    fn touch(&mut self, touch: &Touch) {
        let now_s = self.now_s();
        let px = DVec2::new(touch.location.x, touch.location.y);
        // egui knows of a finger on a panel only when it has drawn the next frame.
        let at = (px / f64::from(self.egui.pixels_per_point())).as_vec2();
        let layer = self.egui.layer_id_at(egui::pos2(at.x, at.y));
        let on_globe = layer.is_none_or(|layer| layer.order == egui::Order::Background);
        match touch.phase {
            TouchPhase::Started if on_globe => self.viewer.finger_down(touch.id, px, now_s),
            TouchPhase::Started => {}
            TouchPhase::Moved => self.viewer.finger_moved(touch.id, px, now_s),
            TouchPhase::Ended | TouchPhase::Cancelled => self.viewer.finger_up(touch.id, now_s),
        }
    }
}

fn key(key: &WinitKey) -> Option<Key> {
    Some(match key.as_ref() {
        WinitKey::Named(NamedKey::ArrowLeft) | WinitKey::Character("a") => Key::Left,
        WinitKey::Named(NamedKey::ArrowRight) | WinitKey::Character("d") => Key::Right,
        WinitKey::Named(NamedKey::ArrowUp) | WinitKey::Character("w") => Key::Up,
        WinitKey::Named(NamedKey::ArrowDown) | WinitKey::Character("s") => Key::Down,
        WinitKey::Character("+" | "=") => Key::Nearer,
        WinitKey::Character("-") => Key::Farther,
        WinitKey::Character("n" | "r") => Key::NorthUp,
        WinitKey::Named(NamedKey::Home) => Key::Home,
        WinitKey::Named(NamedKey::Space) => Key::Play,
        _ => return None,
    })
}
