//! A pass as a device knows it. What it is bound to is read off its text, so that it is said once.

use wgpu::{BindGroupLayout, BufferBindingType, ComputePipeline};

/// Whether the groups of a pass can have any number of threads; else they have 256, or one.
pub(super) fn has_any_group(source: &str) -> bool {
    source.contains("@workgroup_size(GROUP)")
}

/// Whether several threads can share a row of a pass.
pub(super) fn has_shares(source: &str) -> bool {
    source.contains("override SHARES")
}

/// Threads of a group, and how many of them share a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Threads {
    pub(super) group: u32,
    pub(super) shares: u32,
}

/// One binding of a pass.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    /// Its number in the group.
    pub index: u32,
    /// Name of the variable.
    pub name: &'static str,
    /// Type of the variable.
    content: &'static str,
    pub(super) kind: BufferBindingType,
}

impl Binding {
    /// The same of a buffer of another name.
    pub(super) fn named(&self, name: &'static str) -> Self {
        Self { name, ..self.clone() }
    }

    /// The same in a storage buffer.
    pub(super) fn in_storage(&self) -> Self {
        let kind = match self.kind {
            BufferBindingType::Uniform => BufferBindingType::Storage { read_only: true },
            kind @ BufferBindingType::Storage { .. } => kind,
        };
        Self { kind, ..self.clone() }
    }

    pub(super) fn is_storage(&self) -> bool {
        matches!(self.kind, BufferBindingType::Storage { .. })
    }

    pub(super) fn is_written(&self) -> bool {
        self.kind == BufferBindingType::Storage { read_only: false }
    }

    /// For this use and another one of the same buffer; none if they cannot be one.
    pub(super) fn with(&self, other: &Self) -> Option<Self> {
        let is_same = self.content == other.content && self.is_storage() == other.is_storage();
        let written = if self.is_written() { self } else { other };
        is_same.then(|| written.clone())
    }

    /// Its declaration.
    pub(super) fn wgsl(&self) -> String {
        let space = match self.kind {
            BufferBindingType::Uniform => "uniform",
            BufferBindingType::Storage { read_only: true } => "storage, read",
            BufferBindingType::Storage { read_only: false } => "storage, read_write",
        };
        format!("@group(0) @binding({}) var<{space}> {}: {};\n", self.index, self.name, self.content)
    }
}

/// A compiled pass.
#[derive(Debug)]
pub struct Pipeline {
    /// What it is bound to.
    pub bindings: Vec<Binding>,
    /// Layout of these bindings.
    pub layout: BindGroupLayout,
    /// The pipeline itself.
    pub pipeline: ComputePipeline,
}

/// The bindings that a text declares: one line each, all in group 0.
pub(super) fn bindings(source: &'static str) -> Vec<Binding> {
    source.lines().filter_map(binding).collect()
}

fn binding(line: &'static str) -> Option<Binding> {
    let rest = line.strip_prefix("@group(0) @binding(")?;
    let (index, rest) = rest.split_once(')')?;
    let (space, rest) = rest.trim_start().strip_prefix("var<")?.split_once('>')?;
    let (name, content) = rest.split_once(':')?;
    let content = content.trim().strip_suffix(';')?;
    let kind = match space {
        "uniform" => BufferBindingType::Uniform,
        "storage, read" => BufferBindingType::Storage { read_only: true },
        _ => BufferBindingType::Storage { read_only: false },
    };
    Some(Binding { index: index.parse().ok()?, name: name.trim(), content, kind })
}
