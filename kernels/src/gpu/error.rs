//! What can go wrong on a GPU.

/// Why something could not be done on a GPU. None of these leaves a half-finished step behind.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter.
    #[error(
        "no GPU adapter found; `sorb doctor` lists what there is (on Linux, is a Vulkan driver and libvulkan1 installed?)"
    )]
    NoAdapter,
    /// The adapter does not give a device.
    #[error("adapter `{adapter}` gives no device: {reason}")]
    NoDevice {
        /// Name of the adapter.
        adapter: String,
        /// What the driver says.
        reason: String,
    },
    /// The device was lost. The state of the last step that succeeded is where the world was read back last.
    #[error("the GPU was lost: {reason}")]
    Lost {
        /// What the driver says.
        reason: String,
    },
    /// There is not enough memory, or a buffer would be larger than the device allows.
    #[error("`{buffer}` needs {needed} bytes on the GPU: {reason}")]
    OutOfMemory {
        /// What was to be stored.
        buffer: &'static str,
        /// Its size \[B\].
        needed: u64,
        /// Which limit it exceeds, or what the driver says.
        reason: String,
    },
    /// A scene has more sponges than fit the uniform buffer.
    #[error("{sponges} sponges; the GPU takes at most {limit}")]
    TooManySponges {
        /// Sponges of the scene.
        sponges: usize,
        /// Most that there may be.
        limit: usize,
    },
    /// The driver or the library refused something: a fault of sorb or of the driver.
    #[error("the GPU refused: {reason}")]
    Refused {
        /// What it says.
        reason: String,
    },
}
