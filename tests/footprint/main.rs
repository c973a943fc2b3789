//! Footprints against ray casting and angles, and what they look like in special cases.

mod draws;
mod judge;
mod special;
mod truth;
mod winding;

use crate::judge::judge;

#[test]
fn outlines_are_where_the_sensor_begins_to_see() {
    judge(2_000, draws::case);
}

#[test]
fn fields_of_view_that_touch_the_horizon() {
    judge(1_500, draws::touching);
}

#[test]
#[ignore = "minutes"]
fn a_hundred_thousand_sensors() {
    judge(100_000, draws::case);
    judge(50_000, draws::touching);
}
