//! The CPU that kernels run on: a SIMD level, a pool of threads, and chunks of rows of fixed size.
//!
//! A chunk always has [`CHUNK`] rows whatever the number of threads, and only its own chunk writes a row. Sums over chunks
//! are taken in the order of the chunks. Results therefore do not depend on the number of threads.

use std::fmt;
#[cfg(feature = "threads")]
use std::sync::Arc;

use crate::lanes::SimdLevel;

/// Rows of a chunk.
pub const CHUNK: usize = 64;

/// Error of a CPU context.
#[derive(Debug, thiserror::Error)]
pub enum CpuError {
    /// The machine lacks the level.
    #[error("SIMD level `{level}` is not supported by this machine; supported: {supported}")]
    UnsupportedLevel {
        /// The requested level.
        level: SimdLevel,
        /// The supported levels.
        supported: String,
    },
    /// The number of threads is out of range, or the package was built without threads.
    #[error("{threads} threads asked for: {reason}")]
    Threads {
        /// The requested number.
        threads: usize,
        /// The reason.
        reason: String,
    },
}

/// A SIMD level and a pool of threads.
#[derive(Clone)]
pub struct Cpu {
    level: SimdLevel,
    token: fearless_simd::Level,
    threads: usize,
    #[cfg(feature = "threads")]
    pool: Option<Arc<rayon::ThreadPool>>,
}

impl fmt::Debug for Cpu {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Cpu").field("level", &self.level).field("threads", &self.threads).finish()
    }
}

impl Cpu {
    /// One thread at the given level.
    ///
    /// # Errors
    /// The machine lacks the level.
    pub fn serial(level: SimdLevel) -> Result<Self, CpuError> {
        let token = level.token().ok_or_else(|| CpuError::UnsupportedLevel {
            level,
            supported: SimdLevel::supported().map(SimdLevel::name).collect::<Vec<_>>().join(", "),
        })?;
        Ok(Self {
            level,
            token,
            threads: 1,
            #[cfg(feature = "threads")]
            pool: None,
        })
    }

    /// A pool of its own with `threads` threads (1 to 1024) at the given level.
    ///
    /// # Errors
    /// The machine lacks the level, the number is out of range, or threads could not be started.
    pub fn with_threads(level: SimdLevel, threads: usize) -> Result<Self, CpuError> {
        let cpu = Self::serial(level)?;
        if threads == 1 {
            return Ok(cpu);
        }
        if !(1..=1024).contains(&threads) {
            return Err(CpuError::Threads { threads, reason: "the range is 1 to 1024".to_owned() });
        }
        #[cfg(feature = "threads")]
        {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .thread_name(|index| format!("sorb-{index}"))
                .build()
                .map_err(|error| CpuError::Threads { threads, reason: error.to_string() })?;
            Ok(cpu.with_pool(Arc::new(pool)))
        }
        #[cfg(not(feature = "threads"))]
        Err(CpuError::Threads { threads, reason: "built without the feature `threads`".to_owned() })
    }

    /// The same level on a pool that the host owns.
    #[cfg(feature = "threads")]
    #[must_use]
    pub fn with_pool(mut self, pool: Arc<rayon::ThreadPool>) -> Self {
        self.threads = pool.current_num_threads();
        self.pool = (self.threads > 1).then_some(pool);
        self
    }

    /// The SIMD level.
    #[must_use]
    pub fn simd(&self) -> SimdLevel {
        self.level
    }

    /// Number of threads.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.threads
    }

    /// Proof of the SIMD level, for dispatch.
    pub(crate) fn level(&self) -> fearless_simd::Level {
        self.token
    }

    /// Runs `work` inside the pool, so that the kernels in it need not enter it one by one.
    pub fn enter<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        #[cfg(feature = "threads")]
        if let Some(pool) = &self.pool {
            return pool.install(work);
        }
        work()
    }

    /// Runs both, at the same time if there is a second thread.
    pub(crate) fn join(&self, left: impl FnOnce() + Send, right: impl FnOnce() + Send) {
        #[cfg(feature = "threads")]
        if self.pool.is_some() {
            rayon::join(left, right);
            return;
        }
        left();
        right();
    }

    /// Calls `body` with the first row and the rows of every chunk of `rows`.
    pub(crate) fn for_chunks<R: Rows>(&self, rows: R, body: impl Fn(usize, R) + Sync) {
        self.for_chunks_of(CHUNK, rows, body);
    }

    /// [`Self::for_chunks`] with chunks of `chunk` rows.
    pub(crate) fn for_chunks_of<R: Rows>(&self, chunk: usize, rows: R, body: impl Fn(usize, R) + Sync) {
        let chunks = rows.rows().div_ceil(chunk);
        self.split_chunks(chunk, 0, chunks, self.threads, rows, &|(): &mut (), first, rows| {
            body(first, rows)
        });
    }

    /// [`Self::for_chunks`] with working memory that a thread keeps from chunk to chunk. Its content must not affect the
    /// results.
    pub(crate) fn for_chunks_with<M: Default, R: Rows>(
        &self,
        rows: R,
        body: impl Fn(&mut M, usize, R) + Sync,
    ) {
        let chunks = rows.rows().div_ceil(CHUNK);
        self.split_chunks(CHUNK, 0, chunks, self.threads, rows, &body);
    }

    fn split_chunks<M: Default, R: Rows>(
        &self,
        chunk: usize,
        first: usize,
        chunks: usize,
        parts: usize,
        rows: R,
        body: &(impl Fn(&mut M, usize, R) + Sync),
    ) {
        if parts <= 1 || chunks <= 1 {
            let mut memory = M::default();
            let mut rest = rows;
            for index in 0..chunks {
                let at = rest.rows().min(chunk);
                let (head, tail) = rest.split(at);
                body(&mut memory, (first + index) * chunk, head);
                rest = tail;
            }
            return;
        }
        // Contiguous ranges per thread keep the data of a chunk in the cache of one core from pass to pass.
        let left_parts = parts / 2;
        let left_chunks = chunks * left_parts / parts;
        let at = rows.rows().min(left_chunks * chunk);
        let (left, right) = rows.split(at);
        self.join(
            || self.split_chunks(chunk, first, left_chunks, left_parts, left, body),
            || {
                self.split_chunks(
                    chunk,
                    first + left_chunks,
                    chunks - left_chunks,
                    parts - left_parts,
                    right,
                    body,
                )
            },
        );
    }
}

/// Rows that can be divided among threads.
pub(crate) trait Rows: Send + Sized {
    /// Number of rows.
    fn rows(&self) -> usize;
    /// Rows `..at` and `at..`.
    fn split(self, at: usize) -> (Self, Self);
}

impl<T: Send> Rows for &mut [T] {
    fn rows(&self) -> usize {
        self.len()
    }
    fn split(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

/// A slice with one element for every chunk of [`CHUNK`] rows.
#[derive(Debug)]
pub(crate) struct PerChunk<'a, T>(pub(crate) &'a mut [T]);

impl<T: Send> Rows for PerChunk<'_, T> {
    fn rows(&self) -> usize {
        self.0.len() * CHUNK
    }
    fn split(self, at: usize) -> (Self, Self) {
        let (left, right) = self.0.split_at_mut(at.div_ceil(CHUNK));
        (Self(left), Self(right))
    }
}

macro_rules! rows_of_tuple {
    ($($name:ident $index:tt),*) => {
        impl<$($name: Rows),*> Rows for ($($name,)*) {
            fn rows(&self) -> usize {
                self.0.rows()
            }
            fn split(self, at: usize) -> (Self, Self) {
                $(#[allow(non_snake_case, reason = "one variable per type parameter")]
                let $name = self.$index.split(at);)*
                (($($name.0,)*), ($($name.1,)*))
            }
        }
    };
}
rows_of_tuple!(A 0, B 1);
rows_of_tuple!(A 0, B 1, C 2);
rows_of_tuple!(A 0, B 1, C 2, D 3);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_chunk_is_visited_once_with_its_first_row() {
        for threads in [1, 2, 3, 8] {
            let cpu = Cpu::with_threads(SimdLevel::Fallback, threads).expect("the fallback is always there");
            for rows in [0, 1, 255, 256, 257, 5000] {
                let mut seen = vec![0_usize; rows];
                let mut chunk = vec![usize::MAX; rows.div_ceil(CHUNK)];
                cpu.enter(|| {
                    cpu.for_chunks((&mut seen[..], PerChunk(&mut chunk)), |first, (seen, chunk)| {
                        chunk.0[0] = first;
                        seen.iter_mut().enumerate().for_each(|(row, seen)| *seen += first + row);
                    });
                });
                assert!(seen.iter().enumerate().all(|(row, seen)| *seen == row));
                assert!(chunk.iter().enumerate().all(|(index, first)| *first == index * CHUNK));
            }
        }
    }

    #[test]
    fn bad_requests_are_errors() {
        assert!(Cpu::with_threads(SimdLevel::Fallback, 0).is_err());
        assert!(Cpu::with_threads(SimdLevel::Fallback, 1025).is_err());
        let missing =
            SimdLevel::ALL.into_iter().find(|level| !level.is_supported()).expect("no machine has all");
        assert!(Cpu::serial(missing).expect_err("missing").to_string().contains("fallback"));
    }
}
