use globefill::HatchKind;

use super::*;

fn look_of(base: Look, properties: &str) -> Result<Look, String> {
    let JsonValue::Object(properties) = properties.parse().expect("JSON") else {
        panic!("not an object: {properties}");
    };
    with_properties(base, &properties, Path::new("maps"))
}

fn look(properties: &str) -> Look {
    look_of(Look::default(), properties).expect(properties)
}

#[test]
fn other_properties_say_nothing() {
    for properties in [
        "{}",
        r#"{"name":"A","title":"B","marker-color":"nonsense","fill":null,"stroke-width":null}"#,
    ] {
        assert_eq!(look(properties), Look::default(), "{properties}");
    }
}

#[test]
fn fills_as_simplestyle_has_them() {
    for (properties, rgb, alpha) in [
        (r##"{"fill":"#f00"}"##, Some([1.0, 0.0, 0.0]), Some(0.6)),
        (
            r##"{"fill":"#ff000033"}"##,
            Some([1.0, 0.0, 0.0]),
            Some(0.2),
        ),
        (
            r##"{"fill":"#00ff00","fill-opacity":0.25}"##,
            Some([0.0, 1.0, 0.0]),
            Some(0.25),
        ),
        (r#"{"fill-opacity":"0.25"}"#, None, Some(0.25)),
    ] {
        let look = look(properties);
        assert_eq!((look.rgb, look.alpha), (rgb, alpha), "{properties}");
        assert!(look.is_solid());
    }
}

#[test]
fn strokes_as_simplestyle_has_them() {
    let gray: CssColor = "#555555".parse().unwrap();
    let stroke = look(r#"{"stroke-width":"3"}"#).stroke;
    assert!(stroke.is_drawn);
    assert_eq!(stroke.width, Some(Length::Pixels(3.0)));
    assert_eq!(stroke.color, Some(gray.rgba(1.0)));
    let stroke = look(r#"{"stroke":"red","stroke-opacity":0.5,"stroke-width":"2km"}"#).stroke;
    assert_eq!(stroke.drawn([0.0; 4]).color, [1.0, 0.0, 0.0, 0.5]);
    assert_eq!(stroke.width, Some(Length::Metres(2e3)));
    assert!(!look(r#"{"stroke":"red","stroke-width":0}"#).stroke.is_drawn);
    assert!(!look(r#"{"stroke-align":"outer"}"#).stroke.is_drawn);
    let stroke = look(r#"{"stroke":"red","stroke-align":"outer","stroke-dash":"9,0.75"}"#).stroke;
    assert_eq!(stroke.align, Align::Outer);
    let dash = stroke.dash.unwrap();
    assert_eq!((dash.period, dash.share), (Length::Pixels(9.0), 0.75));
}

#[test]
fn patterns_order_and_light() {
    let look = look(
        r#"{"fill-pattern":"cross","fill-pattern-color":"white","fill-pattern-spacing":"5km",
            "fill-pattern-share":0.5,"fill-pattern-angle":"90","fill-z":-3,"fill-additive":true}"#,
    );
    assert_eq!(look.overlay, Overlay::Hatch(HatchKind::Cross));
    assert_eq!(look.hatch.color, Some([1.0; 4]));
    assert_eq!(look.hatch.spacing, Some(Length::Metres(5e3)));
    assert_eq!(look.hatch.share, Some(0.5));
    assert_eq!(look.hatch.angle_rad, Some(std::f32::consts::FRAC_PI_2));
    assert_eq!((look.z_index, look.blend), (-3, Blend::Additive));
}

#[test]
fn images_lie_beside_the_file() {
    for (pattern, overlay) in [
        ("image:flag.png", Overlay::Image("maps/flag.png".into())),
        ("pattern:a/b.png", Overlay::Pattern("maps/a/b.png".into())),
        ("image:/flag.png", Overlay::Image("/flag.png".into())),
    ] {
        let properties = format!(r#"{{"fill-pattern":"{pattern}"}}"#);
        assert_eq!(look(&properties).overlay, overlay, "{pattern}");
    }
}

#[test]
fn properties_win_over_what_was_there() {
    let base = Look {
        overlay: Overlay::Outline,
        rgb: Some([0.5; 3]),
        alpha: Some(1.0),
        blend: Blend::Additive,
        ..Default::default()
    };
    let look = look_of(base.clone(), r##"{"fill":"#000","fill-additive":"false"}"##).unwrap();
    assert_eq!(look.overlay, Overlay::Solid);
    assert_eq!((look.rgb, look.alpha), (Some([0.0; 3]), Some(0.6)));
    assert_eq!(look.blend, Blend::Alpha);
    let look = look_of(base, r#"{"fill-pattern":"dots"}"#).unwrap();
    assert_eq!(look.overlay, Overlay::Hatch(HatchKind::Dots));
    assert_eq!(look.rgb, Some([0.5; 3]));
}

#[test]
fn nonsense_names_the_property() {
    for (name, value) in [
        ("fill", "5"),
        ("fill", "\"reddish\""),
        ("fill-opacity", "1.5"),
        ("fill-opacity", "\"much\""),
        ("fill-opacity", "[1]"),
        ("stroke", "\"#12\""),
        ("stroke-width", "-1"),
        ("stroke-width", "\"wide\""),
        ("stroke-opacity", "-0.1"),
        ("stroke-align", "\"left\""),
        ("stroke-dash", "\"4,2\""),
        ("fill-pattern", "\"stripes\""),
        ("fill-pattern", "true"),
        ("fill-pattern-color", "{}"),
        ("fill-pattern-spacing", "0"),
        ("fill-pattern-share", "2"),
        ("fill-pattern-angle", "\"NaN\""),
        ("fill-z", "1.5"),
        ("fill-z", "1e10"),
        ("fill-additive", "1"),
    ] {
        let error = look_of(Look::default(), &format!("{{\"{name}\":{value}}}")).unwrap_err();
        let start = format!("property \"{name}\": ");
        assert!(error.starts_with(&start), "{name} = {value}: {error}");
        assert!(!error.contains('\n'));
    }
    let dots = r#"{"fill-pattern":"dots","fill-pattern-share":0.7}"#;
    let error = look_of(Look::default(), dots).unwrap_err();
    assert!(
        error.starts_with("property \"fill-pattern-share\": "),
        "{error}"
    );
}
