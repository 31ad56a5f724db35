/* Builds a scene, steers a hand that squeezes a sponge, pours water, reads positions, saves, restores and compares the digests. */
#include <stdio.h>
#include <stdlib.h>

#include "sorb.h"

static const char *const SCENE =
    "version = 1\n"
    "name = \"press\"\n"
    "domain = { kind = \"box\", minimum = [-0.1, 0.0, -0.1], maximum = [0.1, 0.25, 0.1] }\n"
    "[fluid]\n"
    "spacing = 0.01\n"
    "blocks = [{ minimum = [-0.1, 0.0, -0.1], maximum = [0.1, 0.02, 0.1] }]\n"
    "[[sponges]]\n"
    "name = \"sponge\"\n"
    "edge = 0.025\n"
    "cells = [3, 2, 3]\n"
    "position = [-0.0375, 0.0, -0.0375]\n"
    "[[bodies]]\n"
    "name = \"hand\"\n"
    "kind = \"kinematic\"\n"
    "shape = { kind = \"cuboid\", half_extents = [0.04, 0.01, 0.04] }\n"
    "position = [0.0, 0.08, 0.0]\n";

/* Ends the program with the text of a failure. */
static void must(sorb_status status) {
  if (status != SORB_STATUS_OK) {
    fprintf(stderr, "%s: %s\n", sorb_status_name(status), sorb_last_error());
    exit(1);
  }
}

static uint64_t digest_after(sorb_world *world, int frames) {
  uint64_t digest = 0;
  for (int frame = 0; frame < frames; frame++) must(sorb_world_advance_frame(world, NULL));
  must(sorb_world_digest(world, &digest));
  return digest;
}

/* Height of the highest node of the sponge [m], read where it is. */
static double highest(const sorb_world *world) {
  sorb_view view = {.size = sizeof view};
  double height = 0.0;
  must(sorb_world_view(world, SORB_COLUMN_NODE_POSITIONS, &view));
  for (size_t row = 0; row < view.rows; row++) {
    const float *position = (const float *)((const char *)view.data + row * view.stride);
    if (position[1] > height) height = position[1];
  }
  return height;
}

int main(void) {
  sorb_scene *scene = NULL;
  sorb_world *world = NULL, *restored = NULL;
  uint32_t hand = 0;
  must(sorb_scene_from_toml(SCENE, &scene));
  must(sorb_scene_set(scene, "sponges.sponge.young_modulus=8000"));
  must(sorb_world_new(scene, NULL, &world));
  sorb_scene_free(scene);
  must(sorb_world_find_body(world, "hand", &hand));

  /* A mistake is a status and a text that names key, value and range. */
  const float far_away[3] = {0.0f, 1e6f, 0.0f};
  if (sorb_world_push_pose(world, hand, far_away, NULL, 0.1f) != SORB_STATUS_COMMAND) return 1;
  printf("refused: %s\n", sorb_last_error());

  /* Down onto the sponge within 0.1 s, while water is poured beside it. */
  double before = highest(world);
  const float down[3] = {0.0f, 0.05f, 0.0f}, low[3] = {0.06f, 0.1f, 0.06f}, high[3] = {0.09f, 0.13f, 0.09f};
  must(sorb_world_push_pose(world, hand, down, NULL, 0.1f));
  must(sorb_world_push_pour(world, low, high, NULL));
  digest_after(world, 7);
  sorb_body body = {.size = sizeof body};
  sorb_ledger ledger = {.size = sizeof ledger};
  must(sorb_world_body(world, hand, &body));
  must(sorb_world_ledger(world, &ledger));
  printf("hand at %.3f m, sponge %.3f m high instead of %.3f m, %llu particles poured\n", body.position[1],
         highest(world), before, (unsigned long long)ledger.poured);

  /* The caller owns the memory of the save: ask for its length first. */
  size_t length = 0;
  must(sorb_world_save(world, NULL, 0, &length));
  uint8_t *save = malloc(length);
  if (save == NULL) return 1;
  must(sorb_world_save(world, save, length, &length));
  must(sorb_world_restore(save, length, NULL, &restored));
  free(save);
  uint64_t first = digest_after(world, 2), second = digest_after(restored, 2);
  printf("digests %016llx and %016llx\n", (unsigned long long)first, (unsigned long long)second);
  sorb_world_free(world);
  sorb_world_free(restored);
  return first == second && ledger.poured == 27 ? 0 : 1;
}
