// #include numbers, colour, optics, room, scene, field, tree, shapes, lines, foam, skin, ground, no_balls
// #include setting, events, water, matter, sheet, no_sheet, path, pixels
// The realistic view.

fn seen_at(x: f32, y: f32) -> Shine {
    return radiance(x, y);
}
