//! The text of a dispatch of several passes, made of theirs.

use sorb_shaders::Shader;

use super::{
    Candidate, Dispatched, Mapping,
    access::{occurrences, replaced, without_comments},
};
use crate::gpu::{
    pipeline::Binding,
    twins::{Names, Rows},
};

/// What a pass declares for itself begins a line with one of these.
const DECLARED: [&str; 4] = ["fn ", "struct ", "var<workgroup> ", "var<private> "];

/// Most uniform buffers: see the known faults in `docs/gpu.md`.
const UNIFORM_BUFFERS: usize = 3;
/// What stays one where there are more.
const UNIFORM: [&str; 2] = ["clock", "params"];

/// Rows of passes of one thread a row, where several threads share a row.
const ROWS: &str = "
fn row_of_shared(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    let wide = GROUP / SHARES;
    return select(0xffffffffu, group_of(group, groups) * wide + lane, lane < wide);
}
";

/// The same for controls.
const CONTROLS: &str = "
fn row_of_controls(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    let row = group_of(group, groups) * CONTROLS_PER_GROUP + lane / CONTROL_THREADS;
    return select(0xffffffffu, row, lane % CONTROL_THREADS == 0u);
}
";

/// Arguments that the entry point of a pass may have.
const ARGUMENTS: [&str; 3] = ["group", "groups", "lane"];

/// A text to compile.
#[derive(Clone, Debug)]
pub(in crate::gpu) struct Fused {
    pub(in crate::gpu) text: String,
    pub(in crate::gpu) bindings: Vec<Binding>,
}

/// What a pass shares with others, and what it has for itself: with that what knows something of the pass.
pub(super) fn parts_of(shader: &'static Shader, names: Names) -> (Vec<&'static str>, String) {
    let mut common = shader.common.to_vec();
    let mut own = vec![shader.own];
    let mut words: Vec<&str> = declared(shader.own);
    words.extend(names.iter().map(|(variable, _)| *variable));
    let knows = |words: &[&str], common: &str| {
        let text = without_comments(common);
        words.iter().any(|word| occurrences(&text, word).next().is_some())
    };
    while let Some(index) = common.iter().position(|common| knows(&words, common)) {
        let part = common.remove(index);
        words.extend(declared(part));
        own.push(part);
    }
    (common, own.into_iter().map(without_comments).collect())
}

/// Names that a text declares, but for its bindings.
fn declared(text: &str) -> Vec<&str> {
    let name = |line| {
        let rest = DECLARED.iter().find_map(|word| str::strip_prefix(line, word))?;
        rest.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').next()
    };
    text.lines().filter_map(name).collect()
}

/// Bindings of all passes by the names of the buffers; none if passes have a buffer in different forms.
pub(super) fn bindings_of(dispatched: &Dispatched) -> Option<Vec<Binding>> {
    let mut all: Vec<Binding> = Vec::new();
    for access in dispatched.passes().flat_map(|pass| &pass.accesses) {
        let own = access.binding.named(access.buffer);
        match all.iter_mut().find(|binding| binding.name == own.name) {
            Some(binding) => *binding = binding.with(&own)?,
            None => all.push(own),
        }
    }
    if all.iter().filter(|binding| !binding.is_storage()).count() > UNIFORM_BUFFERS {
        let others = all.iter_mut().filter(|binding| !UNIFORM.contains(&binding.name));
        others.for_each(|binding| *binding = binding.in_storage());
    }
    all.iter_mut().zip(0..).for_each(|(binding, index)| binding.index = index);
    Some(all)
}

/// Parts that passes share, each once.
fn common_of(dispatched: &Dispatched) -> Vec<&'static str> {
    let mut all: Vec<&'static str> = Vec::new();
    for common in dispatched.passes().flat_map(|pass| &pass.common) {
        if !all.contains(common) {
            all.push(common);
        }
    }
    all
}

/// Memory of a group \[B\]: at most what the passes declare.
pub(super) fn workgroup_bytes(dispatched: &Dispatched) -> u32 {
    let own = dispatched.passes().map(|pass| &*pass.own);
    let lines = common_of(dispatched).into_iter().chain(own).flat_map(str::lines);
    lines.filter_map(|line| line.strip_prefix("var<workgroup> ")).map(bytes_of).sum()
}

/// Bytes of a variable of a group.
fn bytes_of(declaration: &str) -> u32 {
    let of_element = if declaration.contains("array<vec") { 16 } else { 4 };
    let threads = crate::gpu::groups::GROUP_THREADS;
    of_element * if declaration.contains("array<") { threads } else { 1 }
}

impl Fused {
    /// None if passes have a buffer in different forms.
    pub(in crate::gpu) fn of(dispatched: &Dispatched) -> Option<Self> {
        let bindings = bindings_of(dispatched)?;
        let mut text = common_of(dispatched).concat();
        let has = |mapping| dispatched.strands.iter().any(|strand| strand.mapping == mapping);
        if has(Mapping::Shared) {
            text.push_str(ROWS);
        }
        if has(Mapping::Controls) {
            text.push_str(CONTROLS);
        }
        bindings.iter().for_each(|binding| text.push_str(&binding.wgsl()));
        let (mut calls, mut index) = (String::new(), 0);
        for (place, strand) in dispatched.strands.iter().enumerate() {
            let mut of_strand = Vec::new();
            for pass in &strand.passes {
                let (own, call) = own_text(pass, strand.mapping, index)?;
                text.push_str(&own);
                of_strand.push(call);
                index += 1;
            }
            let body = of_strand.join("        storageBarrier();\n        workgroupBarrier();\n");
            calls.push_str(&format!("    if (group.z == {place}u) {{\n{body}    }}\n"));
        }
        text.push_str(&format!(
            "@compute @workgroup_size(GROUP)\nfn fused(\n    @builtin(workgroup_id) group: vec3<u32>,\n    \
             @builtin(num_workgroups) groups: vec3<u32>,\n    @builtin(local_invocation_index) lane: u32,\n) {{\n{calls}}}\n"
        ));
        Some(Self { text, bindings })
    }
}

/// The text of a pass with names of its own, and the call of its entry point.
fn own_text(pass: &Candidate, mapping: Mapping, index: usize) -> Option<(String, String)> {
    let mut text: String = pass
        .own
        .lines()
        .filter(|line| !line.starts_with("@group(") && !line.starts_with("@compute"))
        .map(|line| format!("{line}\n"))
        .collect();
    for argument in ["workgroup_id", "num_workgroups", "local_invocation_index"] {
        text = text.replace(&format!("@builtin({argument}) "), "");
    }
    for (variable, buffer) in pass.job.pass.names {
        text = replaced(&text, variable, buffer);
    }
    let entry = format!("fn {}(", pass.job.pass.entry);
    let (_, signature) = text.split_once(&entry)?;
    let (signature, _) = signature.split_once(')')?;
    let has = |argument: &&str| occurrences(signature, argument).next().is_some();
    let arguments: Vec<&str> = ARGUMENTS.into_iter().filter(|argument| has(argument)).collect();
    let call = format!("{}_{index}({});", pass.job.pass.entry, arguments.join(", "));
    let is_one = pass.job.pass.rows == Rows::One;
    let call = if is_one {
        format!("        if (group_of(group, groups) == 0u) {{ {call} }}\n")
    } else {
        format!("        {call}\n")
    };
    for name in declared(&pass.own) {
        text = replaced(&text, name, &format!("{name}_{index}"));
    }
    let row_of = match mapping {
        Mapping::Plain => "row_of",
        Mapping::Shared => "row_of_shared",
        Mapping::Controls => "row_of_controls",
    };
    Some((replaced(&text, "row_of", row_of), call))
}
