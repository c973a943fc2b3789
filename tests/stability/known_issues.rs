//! Cells that fail, and why. Each names its cause as far as it is known.
