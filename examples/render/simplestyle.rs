//! Styles in the properties of GeoJSON features: those of simplestyle-spec 1.1 that fills have, and
//! `fill-pattern…`, `stroke-align`, `stroke-dash`, `fill-z` and `fill-additive` beside them.

use std::path::Path;

use globefill::{
    Align, Blend, Length,
    geo_json::{JsonObject, JsonValue},
};

use crate::{css_color::CssColor, notation, overlay::Overlay, style::Look};

/// What simplestyle says where a feature has a `fill` or a stroke and not the rest.
const FILL_OPACITY: f32 = 0.6;
const STROKE: &str = "#555555";

/// The look of a feature: `look` with what its properties say. Files are named relative to `directory`.
/// The error names the property.
pub fn with_properties(
    mut look: Look,
    properties: &JsonObject,
    directory: &Path,
) -> Result<Look, String> {
    let properties = Properties(properties);
    read_fill(&mut look, &properties)?;
    read_pattern(&mut look, &properties, directory)?;
    read_stroke(&mut look, &properties)?;
    if let Some(z_index) = properties.read("fill-z", integer)? {
        look.z_index = z_index;
    }
    if let Some(is_additive) = properties.read("fill-additive", boolean)? {
        look.blend = match is_additive {
            true => Blend::Additive,
            false => Blend::Alpha,
        };
    }
    Ok(look)
}

fn read_fill(look: &mut Look, properties: &Properties) -> Result<(), String> {
    let fill = properties.read("fill", color)?;
    if let Some(fill) = fill {
        look.rgb = Some(fill.rgb);
        look.alpha = Some(fill.alpha.unwrap_or(FILL_OPACITY));
        if look.overlay == Overlay::Outline {
            look.overlay = Overlay::Solid;
        }
    }
    if let Some(opacity) = properties.read("fill-opacity", share)? {
        look.alpha = Some(opacity);
    }
    Ok(())
}

fn read_pattern(look: &mut Look, properties: &Properties, directory: &Path) -> Result<(), String> {
    let overlay = |value: &JsonValue| Overlay::parse(text(value)?, ':');
    if let Some(overlay) = properties.read("fill-pattern", overlay)? {
        look.overlay = overlay.within(directory);
        look.stroke.is_drawn |= look.overlay == Overlay::Outline;
    }
    let hatch = &mut look.hatch;
    if let Some(color) = properties.read("fill-pattern-color", color)? {
        hatch.color = Some(color.rgba(1.0));
    }
    if let Some(spacing) = properties.read("fill-pattern-spacing", length)? {
        hatch.spacing = Some(spacing);
    }
    if let Some(share) = properties.read("fill-pattern-share", share)? {
        hatch.share = Some(share);
    }
    if let Some(angle) = properties.read("fill-pattern-angle", number)? {
        hatch.angle_rad = Some(angle.to_radians() as f32);
    }
    match hatch.share {
        Some(share) => look
            .overlay
            .check_share(share)
            .map_err(|error| in_property("fill-pattern-share", &error)),
        None => Ok(()),
    }
}

fn read_stroke(look: &mut Look, properties: &Properties) -> Result<(), String> {
    let stroke = &mut look.stroke;
    let color = properties.read("stroke", color)?;
    let opacity = properties.read("stroke-opacity", share)?;
    let width = properties.read("stroke-width", width)?;
    if color.is_some() || opacity.is_some() || width.is_some() {
        if !stroke.is_drawn {
            let usual: CssColor = STROKE.parse()?;
            stroke.color = Some(usual.rgba(1.0));
            stroke.is_drawn = true;
        }
        if let Some(color) = color {
            stroke.color = Some(color.rgba(1.0));
        }
        stroke.opacity = opacity.or(stroke.opacity);
    }
    match width {
        Some(Some(width)) => stroke.width = Some(width),
        Some(None) => stroke.is_drawn = false,
        None => {}
    }
    if let Some(align) = properties.read("stroke-align", align)? {
        stroke.align = align;
    }
    if let Some(dash) = properties.read("stroke-dash", |value| notation::dash(&written(value)?))? {
        stroke.dash = Some(dash);
    }
    Ok(())
}

/// The properties of one feature.
struct Properties<'a>(&'a JsonObject);

impl Properties<'_> {
    /// The property, if the feature has it; null is none.
    fn read<Value>(
        &self,
        name: &str,
        read: impl Fn(&JsonValue) -> Result<Value, String>,
    ) -> Result<Option<Value>, String> {
        match self.0.get(name) {
            None | Some(JsonValue::Null) => Ok(None),
            Some(value) => read(value)
                .map(Some)
                .map_err(|error| in_property(name, &error)),
        }
    }
}

fn in_property(name: &str, error: &str) -> String {
    format!("property {name:?}: {error}")
}

fn text(value: &JsonValue) -> Result<&str, String> {
    value.as_str().ok_or_else(|| "expected a text".into())
}

/// A number or a text, as written.
fn written(value: &JsonValue) -> Result<String, String> {
    match value {
        JsonValue::Number(number) => Ok(number.to_string()),
        JsonValue::String(text) => Ok(text.clone()),
        _ => Err("expected a number".into()),
    }
}

fn number(value: &JsonValue) -> Result<f64, String> {
    crate::host::cli::parse_finite(&written(value)?)
}

fn share(value: &JsonValue) -> Result<f32, String> {
    notation::share(&written(value)?)
}

fn length(value: &JsonValue) -> Result<Length, String> {
    notation::length(&written(value)?)
}

/// A width; `None` for no line.
fn width(value: &JsonValue) -> Result<Option<Length>, String> {
    match number(value) {
        Ok(0.0) => Ok(None),
        _ => length(value).map(Some),
    }
}

fn color(value: &JsonValue) -> Result<CssColor, String> {
    text(value)?.parse()
}

fn integer(value: &JsonValue) -> Result<i32, String> {
    let number = number(value)?;
    if number.fract() == 0.0 && number >= f64::from(i32::MIN) && number <= f64::from(i32::MAX) {
        Ok(number as i32)
    } else {
        Err("expected a whole number of 32 bits".into())
    }
}

fn boolean(value: &JsonValue) -> Result<bool, String> {
    match value {
        JsonValue::Bool(value) => Ok(*value),
        JsonValue::String(text) if text == "true" => Ok(true),
        JsonValue::String(text) if text == "false" => Ok(false),
        _ => Err("expected true or false".into()),
    }
}

fn align(value: &JsonValue) -> Result<Align, String> {
    match text(value)? {
        "inner" => Ok(Align::Inner),
        "center" => Ok(Align::Center),
        "outer" => Ok(Align::Outer),
        _ => Err("expected inner, center or outer".into()),
    }
}

#[cfg(test)]
#[path = "simplestyle_tests.rs"]
mod tests;
