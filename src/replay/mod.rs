//! Recordings: what a host did to a world, with a digest of every frame, to play it again.
//!
//! A [`Recorder`] takes the frames and the commands of a host, a [`Player`] plays a [`Recording`] and compares every frame with its
//! digest. Key frames are saves on the way, to seek to, and to name what differs. Neither needs a file system.

mod player;
mod recorder;
mod recording;

pub use player::{Mismatch, Player, ReplayError};
pub use recorder::Recorder;
pub use recording::Recording;
