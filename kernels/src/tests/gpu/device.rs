//! What a device must do whatever runs on it.
