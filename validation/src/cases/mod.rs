//! The cases, in the order in which they are listed and run.

mod bar;
mod bridge;
mod cantilever;
mod channel;
mod consolidation;
mod dam_break;
mod dam_spheric;
mod drop;
mod duct;
mod everyday;
mod floating;
mod honey;
mod hydrostatic;
mod imbibition;
mod litre;
mod momentum;
mod patch;
mod permeameter;
mod rest;
mod shear_wave;
mod sinking;
mod slope;
mod sloshing;
mod splash;
mod squash;
mod squeeze;
mod strain;
mod taylor_green;
mod u_tube;
mod wetting;

use crate::case::Case;

/// All cases.
pub const CASES: &[&Case] = &[
    &hydrostatic::CASE,
    &dam_break::CASE,
    &dam_spheric::CASE,
    &taylor_green::CASE,
    &floating::CASE,
    &sinking::CASE,
    &shear_wave::CASE,
    &slope::CASE,
    &sloshing::CASE,
    &u_tube::CASE,
    &litre::CASE,
    &splash::CASE,
    &drop::CASE,
    &bridge::CASE,
    &channel::CASE,
    &honey::CASE,
    &patch::CASE,
    &cantilever::CANTILEVER,
    &strain::UNIAXIAL,
    &strain::CONFINED,
    &strain::TORSION,
    &squash::CASE,
    &cantilever::VIBRATION,
    &imbibition::WASHBURN,
    &imbibition::BATH,
    &permeameter::CASE,
    &consolidation::CASE,
    &momentum::CASE,
    &squeeze::CASE,
    &wetting::SWELLING,
    &wetting::SOFTENING,
    &wetting::DRAINAGE,
    &wetting::RECEDING,
    &everyday::WATER,
    &everyday::BODIES,
    &everyday::SPONGES,
    &rest::CASE,
];
