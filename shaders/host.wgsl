// What kind of host it is; the rest is compiled away.

// Lines of sight are parallel: w is 1, and distances are along the view axis.
override PARALLEL: bool = false;
// Depths in proportion to a logarithm of the distance.
override LOGARITHMIC: bool = false;

