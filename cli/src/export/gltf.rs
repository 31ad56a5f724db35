//! Binary glTF 2.0: water as points, sponges as triangles with saturation as an own attribute, bodies as triangles at their poses.

use serde_json::{Value, json};

use super::{
    bodies::Bodies,
    snapshot::{Snapshot, floats, integers},
};
use crate::error::CliError;

const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;
const POINTS: u32 = 0;
const TRIANGLES: u32 = 4;
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// The parts of a file while it is made.
#[derive(Default)]
struct Parts {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    nodes: Vec<Value>,
}

/// The file of a frame.
///
/// # Errors
/// The description cannot be written as JSON; never for finite numbers.
pub(super) fn file(frame: &Snapshot) -> Result<Vec<u8>, CliError> {
    let mut parts = Parts::default();
    // A mesh without vertices is not allowed.
    if !frame.particles.is_empty() {
        let attributes = json!({
            "POSITION": parts.places(&frame.particles),
            "_VELOCITY": parts.accessor((floats(frame.velocities.as_flattened()), frame.velocities.len()), "VEC3"),
            "_PRESSURE": parts.accessor((floats(&frame.pressures), frame.pressures.len()), "SCALAR"),
        });
        parts.mesh("water", json!({ "attributes": attributes, "mode": POINTS }));
    }
    if !frame.triangles.is_empty() {
        let attributes = json!({
            "POSITION": parts.places(&frame.nodes),
            "_SATURATION": parts.accessor((floats(&frame.saturations), frame.saturations.len()), "SCALAR"),
        });
        let indices = parts.indices(&frame.triangles);
        parts.mesh("sponges", json!({ "attributes": attributes, "indices": indices, "mode": TRIANGLES }));
    }
    parts.bodies(&frame.bodies);
    parts.finish()
}

impl Parts {
    fn view(&mut self, bytes: Vec<u8>, target: u32) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target,
        }));
        self.bytes.extend(bytes);
        self.views.len() - 1
    }

    fn accessor(&mut self, (bytes, count): (Vec<u8>, usize), kind: &str) -> usize {
        let view = self.view(bytes, VERTICES);
        self.accessors
            .push(json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": kind }));
        self.accessors.len() - 1
    }

    /// Positions, whose bounds must be given.
    fn places(&mut self, rows: &[[f32; 3]]) -> usize {
        let accessor = self.accessor((floats(rows.as_flattened()), rows.len()), "VEC3");
        let bound = |pick: fn(f32, f32) -> f32| {
            rows.iter().copied().reduce(|a, b| [pick(a[0], b[0]), pick(a[1], b[1]), pick(a[2], b[2])])
        };
        self.accessors[accessor]["min"] = json!(bound(f32::min));
        self.accessors[accessor]["max"] = json!(bound(f32::max));
        accessor
    }

    /// Corners of triangles.
    fn indices(&mut self, triangles: &[[u32; 3]]) -> usize {
        let view = self.view(integers(triangles.as_flattened()), INDICES);
        let count = 3 * triangles.len();
        self.accessors
            .push(json!({ "bufferView": view, "componentType": UNSIGNED, "count": count, "type": "SCALAR" }));
        self.accessors.len() - 1
    }

    /// A node of the same name shows the mesh.
    fn mesh(&mut self, name: &str, primitive: Value) {
        self.nodes.push(json!({ "name": name, "mesh": self.meshes.len() }));
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
    }

    /// A node for every body, at its pose; that of a plane, which has no end, shows nothing.
    fn bodies(&mut self, bodies: &Bodies) {
        let poses = bodies.positions.iter().zip(&bodies.rotations);
        for ((name, mesh), (position, rotation)) in bodies.names.iter().zip(&bodies.meshes).zip(poses) {
            if mesh.triangles.is_empty() {
                self.nodes.push(json!({ "name": name }));
            } else {
                let vertices: Vec<[f32; 3]> = mesh.vertices.iter().map(|vertex| vertex.to_array()).collect();
                let attributes = json!({ "POSITION": self.places(&vertices) });
                let indices = self.indices(&mesh.triangles);
                self.mesh(name, json!({ "attributes": attributes, "indices": indices, "mode": TRIANGLES }));
            }
            if let Some(node) = self.nodes.last_mut() {
                node["translation"] = json!(position);
                node["rotation"] = json!(rotation);
            }
        }
    }

    fn finish(self) -> Result<Vec<u8>, CliError> {
        let roots: Vec<usize> = (0..self.nodes.len()).collect();
        let mut description = json!({ "asset": { "version": "2.0", "generator": "sorb" }, "scene": 0 });
        // Empty lists are not allowed.
        description["scenes"] = if roots.is_empty() { json!([{}]) } else { json!([{ "nodes": roots }]) };
        let lists = [
            ("nodes", self.nodes),
            ("meshes", self.meshes),
            ("accessors", self.accessors),
            ("bufferViews", self.views),
        ];
        for (name, list) in lists.into_iter().filter(|(_, list)| !list.is_empty()) {
            description[name] = Value::Array(list);
        }
        if !self.bytes.is_empty() {
            description["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        }
        let mut text = serde_json::to_vec(&description)?;
        text.resize(text.len().next_multiple_of(4), b' ');
        let chunks = [(b"JSON", text), (b"BIN\0", self.bytes)];
        let chunks: Vec<_> = chunks.into_iter().filter(|(_, bytes)| !bytes.is_empty()).collect();
        let length: usize = 12 + chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
        let mut file = b"glTF\x02\0\0\0".to_vec();
        file.extend((length as u32).to_le_bytes());
        for (kind, bytes) in chunks {
            file.extend((bytes.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(bytes);
        }
        Ok(file)
    }
}
