// #include numbers, colour, optics, room, scene, tree, shapes, lines, foam, skin, ground, balls, setting
// #include events, no_water, matter, sheet, no_sheet, path, pixels
// Views of particles, nodes and sponges without the surface of the water.

fn seen_at(x: f32, y: f32) -> Shine {
    return radiance(x, y);
}
