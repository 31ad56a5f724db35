//! Recordings that play.

use sorb::{Options, Player, Recording, World};

use crate::page::Failure;

/// A recording that plays.
pub(crate) struct Playing {
    /// Ends before its recording. It is only empty while this is dropped.
    player: Option<Player<'static>>,
    /// From a box, which this owns.
    recording: *mut Recording,
    /// Its number of frames and single steps.
    ticks: u64,
}

impl Playing {
    pub(crate) fn new(bytes: &[u8]) -> Result<Self, Failure> {
        let recording = Recording::read(bytes)?;
        let ticks = recording.ticks();
        let recording = Box::into_raw(Box::new(recording));
        let mut playing = Self { player: None, recording, ticks };
        // SAFETY: the box lives until `playing` is dropped, which drops the player first; nothing else points to it meanwhile.
        let recording: &'static Recording = unsafe { &*recording };
        playing.player = Some(Player::new(recording, &Options::default())?);
        Ok(playing)
    }

    pub(crate) fn world(&self) -> &World {
        self.player().world()
    }

    /// The present frame, and their number.
    pub(crate) fn frames(&self) -> (u64, u64) {
        (self.player().frame(), self.ticks)
    }

    /// Plays a frame, and compares its digest; at the end nothing happens.
    pub(crate) fn advance(&mut self) -> Result<(), Failure> {
        if let Some(player) = &mut self.player {
            player.advance()?;
        }
        Ok(())
    }

    fn player(&self) -> &Player<'static> {
        self.player.as_ref().expect("one is made with the recording")
    }
}

impl Drop for Playing {
    fn drop(&mut self) {
        self.player = None;
        // SAFETY: it came from a box, and the player that borrowed it is gone.
        drop(unsafe { Box::from_raw(self.recording) });
    }
}

/// Plays a recording to its end, and compares every frame.
pub(crate) fn verify(bytes: &[u8]) -> Result<Vec<u8>, Failure> {
    let recording = Recording::read(bytes)?;
    let mut player = Player::new(&recording, &Options::default())?;
    while player.advance()? {}
    Ok(player.frame().to_string().into_bytes())
}
