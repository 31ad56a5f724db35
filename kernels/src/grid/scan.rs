//! Prefix sums in pages of 32 x 32 values, as in the paper (section 3.1).

use crate::cpu::Cpu;

/// Values of a page.
pub(crate) const PAGE: usize = 32 * 32;

/// Replaces every value by the sum of all values before it, and returns the sum of all.
///
/// Pages are summed in parallel, the sums of the pages are scanned, and the pages are scanned in parallel from
/// there. Integer sums do not depend on the order.
pub(crate) fn exclusive(cpu: &Cpu, values: &mut [u32], page_sums: &mut Vec<u32>) -> u32 {
    if values.len() <= PAGE {
        return scan(values, 0);
    }
    page_sums.clear();
    page_sums.resize(values.len().div_ceil(PAGE), 0);
    {
        let values = &*values;
        cpu.for_chunks_of(1, &mut page_sums[..], |page, sum| {
            let end = values.len().min((page + 1) * PAGE);
            sum[0] = values[page * PAGE..end].iter().sum();
        });
    }
    let total = scan(page_sums, 0);
    let page_sums = &*page_sums;
    cpu.for_chunks_of(PAGE, values, |first, values| {
        scan(values, page_sums[first / PAGE]);
    });
    total
}

fn scan(values: &mut [u32], mut sum: u32) -> u32 {
    for value in values {
        let next = sum + *value;
        *value = sum;
        sum = next;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::SimdLevel;

    #[test]
    fn pages_give_the_sums_of_a_plain_loop() {
        let cpu = Cpu::with_threads(SimdLevel::best(), 3).expect("the best level is there");
        for length in [0, 1, 1023, 1024, 1025, 50_000] {
            let values: Vec<u32> = (0..length).map(|i| (i * 7919) % 13).collect();
            let mut scanned = values.clone();
            let total = cpu.enter(|| exclusive(&cpu, &mut scanned, &mut Vec::new()));
            let mut sum = 0;
            for (value, scanned) in values.iter().zip(&scanned) {
                assert_eq!(*scanned, sum);
                sum += value;
            }
            assert_eq!(total, sum);
        }
    }
}
