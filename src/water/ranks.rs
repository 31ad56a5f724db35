//! Ranks of identities, for lists that have one entry for every particle that there is.

/// For every row the rank of its identity among all; the identity itself where none is missing.
pub(crate) fn ranks(ids: &[u32]) -> Vec<u32> {
    if ids.iter().all(|id| (*id as usize) < ids.len()) {
        return ids.to_vec();
    }
    let mut rows: Vec<u32> = (0..ids.len() as u32).collect();
    rows.sort_unstable_by_key(|row| ids[*row as usize]);
    let mut ranks = vec![0; ids.len()];
    for (rank, row) in rows.into_iter().enumerate() {
        ranks[row as usize] = rank as u32;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_places_in_the_order_of_the_identities() {
        assert_eq!(ranks(&[2, 0, 1]), [2, 0, 1]);
        assert_eq!(ranks(&[7, 100, 0, 9]), [1, 3, 0, 2]);
        assert_eq!(ranks(&[]), [0_u32; 0]);
    }
}
