// #include numbers, optics, scene, tree, shapes, foam, skin, balls, setting, events, no_water, photons
// Light on its way past balls.
