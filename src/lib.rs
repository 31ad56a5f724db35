//! sorb.
