/* The C interface of sorb: an absorbent sponge, the water it drinks and the bodies that squeeze it.
 *
 * Made by cbindgen of the Rust sources, which have the same comments. SI units, Y is up.
 *
 * - Every function that can fail returns a status; sorb_last_error has the text of the last failure of the thread.
 * - Handles are opaque. Each has a function that frees it, which takes NULL as well. One thread at a time may use a handle; different
 *   handles may be used side by side.
 * - Nothing that one side has allocated is freed by the other. Results go into the caller's memory; where their length is not known
 *   before, a call with a NULL buffer tells it.
 * - Structs that begin with `size` must have it set to their `sizeof` before the call, so that later versions can add members.
 * - Texts are UTF-8 and end with a zero.
 * - A failed call changes nothing, but for a failed step, after which a world takes no further steps.
 */

#ifndef SORB_H
#define SORB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// How a call ended.
enum sorb_status
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It did what it says.
  SORB_STATUS_OK = 0,
  // A pointer is NULL that must not be.
  SORB_STATUS_NULL_POINTER = 1,
  // A text is not UTF-8.
  SORB_STATUS_NOT_UTF8 = 2,
  // The `size` of a struct, or a length, is impossible.
  SORB_STATUS_BAD_SIZE = 3,
  // The buffer is too small; the length that it needs was given back.
  SORB_STATUS_BUFFER_TOO_SMALL = 4,
  // A number or a name is none of those that there are.
  SORB_STATUS_NO_SUCH_THING = 5,
  // A scene cannot be read, changed or used.
  SORB_STATUS_SCENE = 6,
  // A world cannot be built: its scene, threads, SIMD level or backend.
  SORB_STATUS_WORLD = 7,
  // A step failed. The world takes no further ones.
  SORB_STATUS_STEP = 8,
  // A command is out of range, or of something that does not exist.
  SORB_STATUS_COMMAND = 9,
  // A question is out of range.
  SORB_STATUS_QUERY = 10,
  // A save is not usable, or cannot be made.
  SORB_STATUS_STATE = 11,
  // A recording is not usable, does not fit the call, or was not played to the same digests.
  SORB_STATUS_RECORDING = 12,
  // A defect of the library. The world that was changed meanwhile is refused from then on.
  SORB_STATUS_PANIC = 13,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sorb_status sorb_status;
#else
typedef int32_t sorb_status;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A quantity. Vectors are x, y, z. Rows of particles change their order from step to step, and
// `SORB_COLUMN_PARTICLE_IDS` identifies them; rows of nodes keep theirs.
enum sorb_column
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Positions of the particles (m): 3 floats.
  SORB_COLUMN_PARTICLE_POSITIONS = 0,
  // Velocities of the particles (m/s): 3 floats.
  SORB_COLUMN_PARTICLE_VELOCITIES = 1,
  // Identities of the particles: 1 unsigned integer.
  SORB_COLUMN_PARTICLE_IDS = 2,
  // Pressures of the particles in the last step (Pa): 1 float. Computed: to copy, not to view.
  SORB_COLUMN_PARTICLE_PRESSURES = 3,
  // Densities of the particles by summation (kg/m^3): 1 float. Computed: to copy, not to view.
  SORB_COLUMN_PARTICLE_DENSITIES = 4,
  // Positions of the nodes of all sponges (m): 3 floats.
  SORB_COLUMN_NODE_POSITIONS = 5,
  // Velocities of the nodes (m/s): 3 floats.
  SORB_COLUMN_NODE_VELOCITIES = 6,
  // Saturation of the nodes, about 0 to 1: 1 float. No rows without fluid.
  SORB_COLUMN_NODE_SATURATIONS = 7,
  // Masses of the dry nodes (kg): 1 float. Computed: to copy, not to view.
  SORB_COLUMN_NODE_MASSES = 8,
  // Number of the sponge of every node: 1 unsigned integer.
  SORB_COLUMN_NODE_SPONGES = 9,
  // Outer surface of the sponges: 3 unsigned integers, the nodes of a triangle, counter-clockwise as seen from outside.
  SORB_COLUMN_TRIANGLES = 10,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sorb_column sorb_column;
#else
typedef uint32_t sorb_column;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Type of the elements of a column.
enum sorb_element_type
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // A float of 32 bits.
  SORB_ELEMENT_TYPE_F32 = 0,
  // An unsigned integer of 32 bits.
  SORB_ELEMENT_TYPE_U32 = 1,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sorb_element_type sorb_element_type;
#else
typedef uint32_t sorb_element_type;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What moves a body.
enum sorb_body_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Forces and contacts.
  SORB_BODY_KIND_DYNAMIC = 0,
  // Nothing.
  SORB_BODY_KIND_FIXED = 1,
  // Its motions, and poses that a host commands.
  SORB_BODY_KIND_KINEMATIC = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sorb_body_kind sorb_body_kind;
#else
typedef uint32_t sorb_body_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a ray has met.
enum sorb_surface
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Nothing.
  SORB_SURFACE_NONE = 0,
  // A body.
  SORB_SURFACE_BODY = 1,
  // A sponge.
  SORB_SURFACE_SPONGE = 2,
  // Water.
  SORB_SURFACE_WATER = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sorb_surface sorb_surface;
#else
typedef uint32_t sorb_surface;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What rays may meet: a sum of these.
enum sorb_target
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Rigid bodies.
  SORB_TARGET_BODIES = 1,
  // The outer surfaces of sponges.
  SORB_TARGET_SPONGES = 2,
  // The surface of the water, also that in sponges.
  SORB_TARGET_WATER = 4,
  // Everything.
  SORB_TARGET_ALL = 7,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum sorb_target sorb_target;
#else
typedef uint32_t sorb_target;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A scene: everything that a world begins with.
typedef struct sorb_scene sorb_scene;

// A state in memory, to roll back to.
typedef struct sorb_snapshot sorb_snapshot;

// A scene in motion.
typedef struct sorb_world sorb_world;

// Simulated time.
typedef struct sorb_clock {
  // `sizeof(sorb_clock)`.
  size_t size;
  // Time since the start (s).
  double time;
  // Steps taken.
  uint64_t steps;
  // Frames completed.
  uint64_t frames;
} sorb_clock;

// Masses, momenta, energies and errors of a state.
typedef struct sorb_measures {
  // `sizeof(sorb_measures)`.
  size_t size;
  // Simulated time (s).
  double time;
  // Mass of all water (kg).
  double water_mass;
  // Mass of the water inside sponges (kg).
  double absorbed_mass;
  // Water-filled pore volume over pore volume at rest (1).
  double saturation;
  // Height of the highest node that is more than half saturated, above the lowest node (m).
  double wicking_height;
  // Volume of all sponges (m^3), pores included.
  double sponge_volume;
  // Centre of mass of the dry sponges (m).
  double sponge_centre[3];
  // Momentum of water, sponges and bodies (kg m/s).
  double linear_momentum[3];
  // Angular momentum about the origin (kg m^2/s).
  double angular_momentum[3];
  // Kinetic energy (J).
  double kinetic_energy;
  // Potential energy in the gravity field, zero at the origin (J).
  double potential_energy;
  // Elastic energy of the sponges (J).
  double elastic_energy;
  // Largest speed of particles and nodes (m/s).
  double maximum_speed;
  // Mean of max(density / rest density - 1, 0) over the particles (1).
  double mean_density_error;
  // Largest density / rest density - 1, at least zero (1).
  double maximum_density_error;
} sorb_measures;

// Where all water came from and went, in particles.
typedef struct sorb_ledger {
  // `sizeof(sorb_ledger)`.
  size_t size;
  // Those that the scene began with.
  uint64_t seeded;
  // Those that were poured, by commands and by emitters.
  uint64_t poured;
  // Those that were removed.
  uint64_t removed;
  // Those that drains have taken.
  uint64_t drained;
  // Those that are there.
  uint64_t present;
  // Those of the present ones that sponges hold.
  uint64_t absorbed;
  // Places of pours in which there was no room.
  uint64_t left_out;
  // Always 0.
  int64_t lost;
  // Mass of a particle (kg); 0 without fluid.
  float particle_mass;
} sorb_ledger;

// What a world runs on. Zeros are the defaults. Threads and SIMD level have no effect on results.
typedef struct sorb_options {
  // `sizeof(sorb_options)`.
  size_t size;
  // Number of threads, 1 to 1024; 0: one per core.
  uint32_t threads;
  // SIMD level: "fallback", "sse4.2", "avx2", "avx512" or "neon"; NULL: the best of the machine.
  const char *simd;
  // Where it runs: "cpu", "gpu", "auto" or another text that `sorb run --backend` takes; NULL: "cpu". "gpu" needs a library that was
  // built with the feature `gpu`.
  const char *backend;
} sorb_options;

// Result of a step.
typedef struct sorb_step_report {
  // `sizeof(sorb_step_report)`.
  size_t size;
  // Time after the step (s).
  double time;
  // Length of the step (s).
  float step;
  // Largest speed of particles and nodes after the step (m/s).
  float maximum_speed;
} sorb_step_report;

// Result of a frame.
typedef struct sorb_frame_report {
  // `sizeof(sorb_frame_report)`.
  size_t size;
  // Time after the frame (s).
  double time;
  // Steps of the frame.
  uint32_t steps;
  // Shortest step of the frame (s); infinite if there was none.
  float shortest_step;
  // Largest speed of particles and nodes in the frame (m/s).
  float maximum_speed;
} sorb_frame_report;

// Pose and velocity of a body.
typedef struct sorb_body {
  // `sizeof(sorb_body)`.
  size_t size;
  // What moves it: a `sorb_body_kind`.
  uint32_t kind;
  // Centre of mass (m): x, y, z.
  float position[3];
  // Rotation from its frame to the world, a quaternion of unit length: x, y, z, w.
  float rotation[4];
  // Velocity of the centre of mass (m/s).
  float linear_velocity[3];
  // Angular velocity, in the frame of the world (rad/s).
  float angular_velocity[3];
} sorb_body;

// Force and torque about the centre of mass of a body.
typedef struct sorb_load {
  // Force (N).
  double force[3];
  // Torque (N m).
  double torque[3];
} sorb_load;

// What acts on a body beside its weight, by its source: means over the steps of the last frame, zeros before the first.
typedef struct sorb_body_loads {
  // `sizeof(sorb_body_loads)`.
  size_t size;
  // By the fluid.
  struct sorb_load fluid;
  // By sponges.
  struct sorb_load sponges;
  // By forces that the host commands.
  struct sorb_load host;
  // By other bodies and the walls of the container; zero for bodies that are not dynamic.
  struct sorb_load contact;
} sorb_body_loads;

// A column in the memory of a world, to read only.
typedef struct sorb_view {
  // `sizeof(sorb_view)`.
  size_t size;
  // Its first element. Not NULL, also without rows.
  const void *data;
  // Number of rows.
  size_t rows;
  // Bytes from a row to the next.
  size_t stride;
  // Elements of a row that mean something; what follows them in its stride is internal.
  uint32_t components;
  // Their type: a `sorb_element_type`.
  uint32_t element_type;
} sorb_view;

// A body or a sponge for ever: its number, and how many had that number before it, which is 0 for those of the scene. Functions that
// take a number alone mean one with a generation of 0; in JSON a handle is `{"index": 0, "generation": 1}`, or the number.
typedef struct sorb_handle {
  // Its number.
  uint32_t index;
  // How many had this number before it.
  uint32_t generation;
} sorb_handle;

// A ray.
typedef struct sorb_ray {
  // Where it begins, -1000 to 1000 m.
  float origin[3];
  // Its direction, of any length but zero.
  float direction[3];
  // Its length, 0 to 2000 m.
  float length;
} sorb_ray;

// Where a ray meets something; zeros if it meets nothing.
typedef struct sorb_hit {
  // Distance from the origin of the ray (m).
  float distance;
  // The place (m).
  float point[3];
  // Outward normal of the surface there, of unit length.
  float normal[3];
  // What it is: a `sorb_surface`.
  uint32_t surface;
  // Number of the body or the sponge in the scene.
  uint32_t number;
} sorb_hit;

// What is at a point.
typedef struct sorb_probe {
  // Share of the space around the point that is water, about 0 to 1.
  float filled;
  // Mass of water over space around the point (kg/m^3).
  float density;
  // Mean velocity of the water around the point (m/s); zero where there is none.
  float velocity[3];
  // Mean pressure of the water around the point (Pa); zero where there is none.
  float pressure;
  // Number of the sponge that the point lies in; -1 if it lies in none, and the rest is zero.
  int32_t sponge;
  // Water-filled pore volume over pore volume there, about 0 to 1.
  float saturation;
  // Pressure of the water in the pores (Pa).
  float pore_pressure;
  // Velocity of the sponge there (m/s).
  float sponge_velocity[3];
  // Volume of the sponge there over that at rest (1).
  float volume_ratio;
} sorb_probe;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Text of the last failure of this thread, which names key, value and range; empty before the first. Never NULL. Valid until the next
// call of this thread that fails, and until the thread ends.
const char *sorb_last_error(void);

// Name of a status, such as "buffer too small"; "unknown status" for other numbers. Never NULL, valid for ever.
const char *sorb_status_name(int32_t status);

// Version of the library, such as "0.1.0". Valid for ever.
const char *sorb_version(void);

// Reads a scene that comes with the library, such as `ball_drop`.
sorb_status sorb_scene_preset(const char *name, struct sorb_scene **scene);

// Reads a scene from a file whose name ends in `.toml` or `.json`.
sorb_status sorb_scene_from_file(const char *path, struct sorb_scene **scene);

// Reads a scene from TOML.
sorb_status sorb_scene_from_toml(const char *toml, struct sorb_scene **scene);

// Reads a scene from JSON.
sorb_status sorb_scene_from_json(const char *json, struct sorb_scene **scene);

// Changes one key: `fluid.spacing=0.004`, `sponges.NAME.porosity=0.8`, `bodies[0].position=[0, 0.1, 0]`. The value is TOML.
sorb_status sorb_scene_set(struct sorb_scene *scene,
                           const char *change);

// Refines a scene, range 0.1 to 8: twice the resolution has 8 times the particles and nodes.
sorb_status sorb_scene_scale(struct sorb_scene *scene, float resolution);

// Copies a scene as JSON, without a zero at its end. `length` is the number of its bytes; a NULL buffer asks for it alone.
sorb_status sorb_scene_to_json(const struct sorb_scene *scene,
                               uint8_t *buffer,
                               size_t capacity,
                               size_t *length);

// Frees a scene.
void sorb_scene_free(struct sorb_scene *scene);

// Simulated time, steps and frames.
sorb_status sorb_world_clock(const struct sorb_world *world, struct sorb_clock *clock);

// Masses, momenta, energies and errors of the present state.
sorb_status sorb_world_measures(const struct sorb_world *world, struct sorb_measures *measures);

// Where all water came from and went.
sorb_status sorb_world_ledger(const struct sorb_world *world, struct sorb_ledger *ledger);

// Builds a world of a scene, which it copies. NULL options are the defaults.
sorb_status sorb_world_new(const struct sorb_scene *scene,
                           const struct sorb_options *options,
                           struct sorb_world **world);

// Copies a world, which continues with the same bits. A recording stays with the first one.
sorb_status sorb_world_clone(const struct sorb_world *world, struct sorb_world **copy);

// Frees a world, and all pointers that `sorb_world_view` gave.
void sorb_world_free(struct sorb_world *world);

// Copies the scene that a world was built from.
sorb_status sorb_world_scene(const struct sorb_world *world, struct sorb_scene **scene);

// Takes one step, as long as stability allows. The report may be NULL. After a failed step every further one fails.
sorb_status sorb_world_step(struct sorb_world *world, struct sorb_step_report *report);

// Takes as many steps as fill a frame of `1 / time.frame_rate` seconds. The report may be NULL. After a failed step every further one
// fails.
sorb_status sorb_world_advance_frame(struct sorb_world *world,
                                     struct sorb_frame_report *report);

// Digest of the state: equal ones continue with the same bits.
sorb_status sorb_world_digest(const struct sorb_world *world, uint64_t *digest);

// Number of a body by its name, from 0.
sorb_status sorb_world_find_body(const struct sorb_world *world, const char *name, uint32_t *body);

// Number of bodies.
sorb_status sorb_world_body_count(const struct sorb_world *world, uint32_t *count);

// Pose and velocity of a body, by its number in the scene, from 0.
sorb_status sorb_world_body(const struct sorb_world *world, uint32_t number, struct sorb_body *body);

// What acts on a body, by its number in the scene, from 0.
sorb_status sorb_world_body_loads(const struct sorb_world *world, uint32_t number, struct sorb_body_loads *loads);

// Borrows a column without a copy. The pointer is valid until the next call that changes or frees the world: steps, frames, commands,
// `sorb_world_resume`, `sorb_world_rollback` and `sorb_world_free`. Columns that are computed are refused: copy them.
sorb_status sorb_world_view(const struct sorb_world *world,
                            uint32_t column,
                            struct sorb_view *view);

// Copies a column, packed: 12 bytes for three elements, 4 for one. `length` is the number of its bytes; a NULL buffer asks for it alone.
sorb_status sorb_world_copy(const struct sorb_world *world,
                            uint32_t column,
                            void *buffer,
                            size_t capacity,
                            size_t *length);

// Any command, as JSON: `{"impulse": {"body": 0, "impulse": [0, 1, 0], "angular_impulse": [0, 0, 0]}}`. The next step begins with all
// commands, in their order. docs/embedding.md lists them, with the functions below for the most frequent ones.
sorb_status sorb_world_push(struct sorb_world *world,
                            const char *json);

// Moves a kinematic body to a pose at constant velocity and rate. `position` (m) has 3 numbers of -1000 to 1000; `rotation` is a
// quaternion of unit length, x, y, z, w, and NULL for none; `duration` is 0.000001 to 100000 s.
sorb_status sorb_world_push_pose(struct sorb_world *world,
                                 uint32_t body,
                                 const float *position,
                                 const float *rotation,
                                 float duration);

// Sets the velocity of a dynamic body: 3 numbers of -100 to 100 m/s, and of -1000 to 1000 rad/s.
sorb_status sorb_world_push_velocity(struct sorb_world *world,
                                     uint32_t body,
                                     const float *linear_velocity,
                                     const float *angular_velocity);

// Sets the force and the torque on a dynamic body for all steps from the next one on. Each has 3 numbers of -1e6 to 1e6, in N and N m.
// Zeros end them.
sorb_status sorb_world_push_force(struct sorb_world *world,
                                  uint32_t body,
                                  const float *force,
                                  const float *torque);

// Gives a dynamic body an impulse and an angular impulse: 3 numbers each of -1e6 to 1e6 N s, and N m s.
sorb_status sorb_world_push_impulse(struct sorb_world *world,
                                    uint32_t body,
                                    const float *impulse,
                                    const float *angular_impulse);

// Sets the acceleration of gravity of everything: 3 numbers of -100 to 100 m/s^2.
sorb_status sorb_world_push_gravity(struct sorb_world *world, const float *gravity);

// Pours water into a box along the axes, from its lowest to its highest corner: 3 numbers each of -1000 to 1000 m. `velocity` has 3
// numbers of -100 to 100 m/s, and NULL is water at rest. Places that are taken are left out; a box without any room is refused.
sorb_status sorb_world_push_pour(struct sorb_world *world,
                                 const float *minimum,
                                 const float *maximum,
                                 const float *velocity);

// Adds a body, and gives its handle, which the next step makes valid. `json` has the keys of a body of a scene (docs/scene-format.md):
// `{"name": "ball", "shape": {"kind": "sphere", "radius": 0.02}, "position": [0, 0.2, 0]}`. A place in a sponge or in water is refused.
sorb_status sorb_world_push_add_body(struct sorb_world *world,
                                     const char *json,
                                     struct sorb_handle *body);

// Removes a body; what it held is let go.
sorb_status sorb_world_push_remove_body(struct sorb_world *world, struct sorb_handle body);

// Gives a body another `sorb_body_kind`, where it is now. A dynamic one begins with its velocity, others rest until a pose is pushed.
sorb_status sorb_world_push_body_kind(struct sorb_world *world,
                                      struct sorb_handle body,
                                      uint32_t kind);

// Adds a sponge, with the water in its pores, and gives its handle, which the next step makes valid. `json` has the keys of a sponge of a
// scene: `{"name": "cube", "edge": 0.02, "cells": [3, 3, 3], "position": [0, 0.1, 0]}`. Rows of nodes change. A place in a body or in
// another sponge is refused.
sorb_status sorb_world_push_add_sponge(struct sorb_world *world,
                                       const char *json,
                                       struct sorb_handle *sponge);

// Removes a sponge; the water in it stays where it is. Rows of nodes change.
sorb_status sorb_world_push_remove_sponge(struct sorb_world *world, struct sorb_handle sponge);

// Puts a sponge elsewhere, in its shape at rest, with the water in its pores. `position` is where the middle of its block goes: 3 numbers
// of -1000 to 1000 m. `rotation` is a quaternion of unit length, x, y, z, w, and NULL for none; `velocity` has 3 numbers of -100 to
// 100 m/s, and NULL is at rest.
sorb_status sorb_world_push_place_sponge(struct sorb_world *world,
                                         struct sorb_handle sponge,
                                         const float *position,
                                         const float *rotation,
                                         const float *velocity);

// Changes the material of a sponge from the next step on: `json` has the keys that change, such as `{"young_modulus": 5000}`.
sorb_status sorb_world_push_material(struct sorb_world *world,
                                     struct sorb_handle sponge,
                                     const char *json);

// Begins a stream of water, and gives its number. `json` has the keys of an emitter of a scene:
// `{"position": [0, 0.2, 0], "velocity": [0, -1, 0], "radius": 0.01}`. It begins at once if its `start` is past.
sorb_status sorb_world_push_emit(struct sorb_world *world, const char *json, uint32_t *flow);

// Opens a drain, and gives its number. `json` has the keys of a drain of a scene:
// `{"minimum": [0, 0, 0], "maximum": [0.1, 0.02, 0.1], "rate": 0.2}`. It opens at once if its `start` is past.
sorb_status sorb_world_push_drain(struct sorb_world *world, const char *json, uint32_t *flow);

// Ends an emitter or a drain by its number; those of the scene count from 0, emitters first. One that has ended is refused.
sorb_status sorb_world_push_end_flow(struct sorb_world *world,
                                     uint32_t flow);

// Moves the container on, after the motions that it has. `json` is a list of motions of a scene, in absolute times:
// `[{"kind": "linear", "velocity": [0.2, 0, 0], "start": 1.0, "end": 1.5, "ease": 0.1}]`.
sorb_status sorb_world_push_container(struct sorb_world *world, const char *json);

// What every ray meets first. `targets` is a sum of `sorb_target`; `hits` has room for `count`.
sorb_status sorb_world_cast_rays(const struct sorb_world *world,
                                 const struct sorb_ray *rays,
                                 size_t count,
                                 uint32_t targets,
                                 struct sorb_hit *hits);

// Height of the highest surface of water at every place (m); NaN where there is no water. `places` has `count` times x and z (m);
// `levels` has room for `count`.
sorb_status sorb_world_water_levels(const struct sorb_world *world,
                                    const float *places,
                                    size_t count,
                                    float *levels);

// What is at every point. `points` has `count` times x, y and z (m); `probes` has room for `count`.
sorb_status sorb_world_probe(const struct sorb_world *world,
                             const float *points,
                             size_t count,
                             struct sorb_probe *probes);

// Copies the state with its scene as a save: the same bytes as a file that `sorb run --from` reads. `length` is the number of its
// bytes; a NULL buffer asks for it alone.
sorb_status sorb_world_save(const struct sorb_world *world,
                            uint8_t *buffer,
                            size_t capacity,
                            size_t *length);

// Builds a world in the state of a save, which continues with the same bits. NULL options are the defaults.
sorb_status sorb_world_restore(const uint8_t *save,
                               size_t length,
                               const struct sorb_options *options,
                               struct sorb_world **world);

// Returns to the state of a save of the same scene, without building anything anew. Refused while a recording runs.
sorb_status sorb_world_resume(struct sorb_world *world, const uint8_t *save, size_t length);

// Makes an empty snapshot.
sorb_status sorb_snapshot_new(struct sorb_snapshot **snapshot);

// Frees a snapshot.
void sorb_snapshot_free(struct sorb_snapshot *snapshot);

// Copies the state into a snapshot, in the memory that it has already.
sorb_status sorb_world_snapshot(const struct sorb_world *world, struct sorb_snapshot *snapshot);

// Returns to a snapshot of this world. Refused while a recording runs, and for an empty snapshot or one of another scene.
sorb_status sorb_world_rollback(struct sorb_world *world,
                                const struct sorb_snapshot *snapshot);

// Begins a recording with the present state: from now on it takes all commands, steps and frames. `key_frame_every` is the number of
// frames from a save in it to the next; 0: none.
sorb_status sorb_world_record(struct sorb_world *world,
                              uint32_t key_frame_every);

// Copies the recording so far: the same bytes as a file that `sorb replay` plays. `length` is the number of its bytes; a NULL buffer asks
// for it alone.
sorb_status sorb_world_recording(const struct sorb_world *world,
                                 uint8_t *buffer,
                                 size_t capacity,
                                 size_t *length);

// Ends the recording of a world, and forgets it.
sorb_status sorb_world_end_recording(struct sorb_world *world);

// Plays a recording to its end, and compares every frame. A frame that differs is a failure that names the frame, and the first column,
// row and both values. `frames` is the number of frames and single steps, and may be NULL; so may the options.
sorb_status sorb_recording_verify(const uint8_t *recording,
                                  size_t length,
                                  const struct sorb_options *options,
                                  uint64_t *frames);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SORB_H */
