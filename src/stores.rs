//! The columns of a world: on the host, and on a device if the step runs there.

use sorb_kernels::columns::Columns;

use crate::gpu::Device;

/// Columns on the host, and their copies on a device.
#[derive(Debug)]
pub(crate) struct Stores {
    /// Columns on the host: the whole state where the step runs on the CPU. Where it runs on a device, constants, the
    /// bodies, and the rest as it was read back last.
    pub(crate) host: Columns,
    pub(crate) device: Option<Device>,
}

impl Stores {
    /// The present state.
    pub(crate) fn view(&self) -> &Columns {
        self.device.as_ref().map_or(&self.host, |device| device.view(&self.host))
    }
}

impl Stores {
    /// Makes the present state that of the host, which a device takes over anew. False if the device is lost.
    pub(crate) fn move_to_host(&mut self) -> bool {
        let Self { host, device } = self;
        device.as_mut().is_none_or(|device| device.move_to_host(host))
    }
}

impl Clone for Stores {
    /// The copy holds the state on the host, and uploads it when it steps: it survives the device of the original.
    fn clone(&self) -> Self {
        Self { host: self.view().clone(), device: self.device.as_ref().map(Device::without_data) }
    }
}
