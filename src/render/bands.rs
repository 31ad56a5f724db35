//! Work on independent bands of rows, on all threads or one. The result of a band does not depend on the number of threads.

/// Runs `work` on every job.
pub(super) fn each<J: Send>(jobs: Vec<J>, work: impl Fn(J) + Sync + Send) {
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        jobs.into_par_iter().for_each(work);
    }
    #[cfg(not(feature = "threads"))]
    jobs.into_iter().for_each(work);
}

/// Runs `work(first row, rows)` on bands of `rows` rows of a buffer of `width` columns.
pub(super) fn each_band<T: Send>(
    buffer: &mut [T],
    width: usize,
    rows: usize,
    work: impl Fn(usize, &mut [T]) + Sync + Send,
) {
    let jobs = buffer.chunks_mut(width * rows).enumerate().collect();
    each(jobs, |(index, band): (usize, &mut [T])| work(index * rows, band));
}

/// Runs `work(row, columns)` on every row of a buffer of `width` columns, `rows` of them at a time.
pub(super) fn each_row<T: Send>(
    buffer: &mut [T],
    width: usize,
    rows: usize,
    work: impl Fn(usize, &mut [T]) + Sync + Send,
) {
    each_band(buffer, width, rows, |first, band| {
        band.chunks_mut(width).enumerate().for_each(|(row, columns)| work(first + row, columns));
    });
}

/// Results of `work` for 0 to `count` less one, in this order.
pub(super) fn map<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    #[cfg(feature = "threads")]
    {
        use rayon::prelude::*;
        (0..count).into_par_iter().map(work).collect()
    }
    #[cfg(not(feature = "threads"))]
    (0..count).map(work).collect()
}

/// Results of two tasks.
pub(super) fn both<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    #[cfg(feature = "threads")]
    {
        rayon::join(a, b)
    }
    #[cfg(not(feature = "threads"))]
    (a(), b())
}
