use super::*;
use crate::sponge::{LatticeError, MAX_CELLS, MAX_EDGE};

fn error(bad: LatticeSponge<'_>) -> LatticeError {
    // Behind a good sponge, so that the index in the error is not the default one.
    Lattice::new(&[sponge([2; 3], &block), bad]).expect_err("the sponge is bad")
}

#[test]
fn bad_numbers_are_named() {
    let good = sponge([2; 3], &block);
    for value in [0.0, -1.0, f32::INFINITY, 2.0 * MAX_EDGE] {
        let found = error(LatticeSponge { edge: value, ..good });
        assert_eq!(found, LatticeError::Edge { sponge: 1, value });
        assert!(found.to_string().starts_with("sponges[1]: edge = "), "{found}");
    }
    assert!(matches!(error(LatticeSponge { edge: f32::NAN, ..good }), LatticeError::Edge { sponge: 1, .. }));
    let found = error(LatticeSponge { cells: [3, 0, 2], ..good });
    assert_eq!(found, LatticeError::NoCells { sponge: 1, value: [3, 0, 2] });
    let found = error(LatticeSponge { origin: Vec3::new(0.0, f32::NAN, 0.0), ..good });
    assert!(matches!(found, LatticeError::Origin { sponge: 1, .. }));
}

#[test]
fn too_many_cells_are_refused_before_anything_is_built() {
    let good = sponge([2; 3], &block);
    for cells in [[u32::MAX; 3], [1 << 20; 3], [512, 512, 512]] {
        let found = error(LatticeSponge { cells, ..good });
        let LatticeError::TooManyCells { sponge: 1, value, total } = found else { panic!("{found}") };
        assert_eq!(value, cells);
        assert!(total > MAX_CELLS);
    }
}

#[test]
fn a_place_beyond_single_precision_is_refused() {
    let good = sponge([2; 3], &block);
    let at = |x: f32| LatticeSponge { origin: Vec3::new(x, 0.0, 0.0), ..good };
    let found = error(at(-1.0e4));
    let LatticeError::Reach { sponge: 1, reach, edge, limit } = found else { panic!("{found}") };
    assert_eq!((reach, edge, limit), (1.0e4, EDGE, 8192.0));
    let far = lattice(&[at(-8192.0)]);
    let off = far.tets.iter().map(|&tet| volume(corners(&far, tet)) * 12.0 / f64::from(EDGE).powi(3) - 1.0);
    assert!(off.map(f64::abs).fold(0.0, f64::max) < 0.05, "tets at the limit keep their shape");
}

#[test]
fn an_empty_shape_is_refused() {
    let found = error(sponge([3; 3], &|_| false));
    assert_eq!(found, LatticeError::Empty { sponge: 1, cells: [3; 3], candidates: 216 });
    assert!(found.to_string().contains("sponges[1]: shape and bodies leave none of the 216 tets"), "{found}");
    let found = error(sponge([1; 3], &block));
    assert_eq!(found, LatticeError::Empty { sponge: 1, cells: [1; 3], candidates: 0 });
}
