// #include numbers, optics, scene, field, tree, shapes, foam, skin, no_balls, setting, events, water, photons
// Light on its way through water.
