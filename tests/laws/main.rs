//! Laws that every mesh keeps, on real countries and on shapes that break others.

mod degenerate;
mod hostile;
mod huge;
mod law;
mod real;
mod shapes;
mod zones;
