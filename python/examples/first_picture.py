"""The first picture: a ball on a wet sponge. `python first_picture.py [picture.png]`"""

import sys

import sorb

world = sorb.World("ball_drop", resolution=0.6)
world.run(seconds=0.2)
measures = world.measures()
print(f"after {world.time:.2f} s the sponge holds {1000 * measures['absorbed_mass']:.0f} g of water")

path = sys.argv[1] if len(sys.argv) > 1 else "first_picture.png"
sorb.write_png(path, world.picture(640, 480))
print(f"wrote {path}")
