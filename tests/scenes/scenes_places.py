"""Scenes that are hard in one known way each: many scales of highlight, light through a gap, sun between columns,
thin things."""

import math

import materials
import shapes
import vec
from demo_objects import chair, coffee_table
from gltf_writer import Builder
from mesh import merged
from shapes import bevel_box, grid
from textures import Random


def room(scene, low, high, colours):
    """Six inward walls between two corners. colours: material index of left, right, floor, ceiling, back, front;
    None leaves one out."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    wide, tall, deep = (x1 - x0, 0.0, 0.0), (0.0, y1 - y0, 0.0), (0.0, 0.0, z1 - z0)
    back = vec.scale(deep, -1.0)
    sides = (
        ("Left wall", (x0, y0, z1), back, tall),
        ("Right wall", (x1, y0, z0), deep, tall),
        ("Floor", (x0, y0, z1), wide, back),
        ("Ceiling", (x0, y1, z0), wide, deep),
        ("Back wall", (x0, y0, z0), wide, tall),
        ("Front wall", (x1, y0, z1), vec.scale(wide, -1.0), tall),
    )
    for (name, origin, u, v), material in zip(sides, colours):
        if material is not None:
            scene.add_object(name, grid(origin, u, v), material)


def veach_mis():
    """Four plates from smooth to rough mirror four spheres of equal power, from small and bright to large and dim
    [Veach 1997, 9.2.2]."""
    scene = Builder("veach-mis")
    grey = scene.add_material(materials.lambert("Grey", (0.3, 0.3, 0.3)))
    scene.add_object("Floor", grid((-6.0, -1.6, 5.0), (12.0, 0.0, 0.0), (0.0, 0.0, -9.0)), grey)
    scene.add_object("Back wall", grid((-6.0, -1.6, -3.0), (12.0, 0.0, 0.0), (0.0, 7.0, 0.0)), grey)
    eye, lights = (0.0, 1.2, 7.0), (0.0, 1.9, -1.6)
    plates = ((0.08, -0.25, -0.9), (0.20, -0.72, -0.1), (0.32, -1.08, 0.8), (0.45, -1.36, 1.8))
    for k, (roughness, y, z) in enumerate(plates):
        centre = (0.0, y, z)
        normal = vec.normalize(vec.add(vec.normalize(vec.sub(eye, centre)), vec.normalize(vec.sub(lights, centre))))
        lean = math.degrees(math.atan2(normal[2], normal[1]))
        metal = scene.add_material(materials.metal(f"Plate roughness {roughness}", (0.6, 0.6, 0.6), roughness))
        scene.add_object(
            f"Plate {k + 1}",
            shapes.box((4.4, 0.04, 0.72)),
            metal,
            translation=centre,
            rotation=vec.quaternion(vec.X, lean),
        )
    tints = ((1.0, 0.62, 0.42), (1.0, 0.9, 0.5), (0.55, 1.0, 0.6), (0.5, 0.7, 1.0))
    for k, (radius, tint) in enumerate(zip((0.035, 0.10, 0.24, 0.42), tints)):
        emitter = scene.add_material(materials.emitter(f"Emitter {k + 1}", vec.scale(tint, 0.8 / radius**2)))
        centre = (-1.8 + 1.2 * k, lights[1], lights[2])
        scene.add_object(f"Sphere {k + 1}", shapes.sphere(radius, 32, 16), emitter, translation=centre)
    fill = scene.add_material(materials.emitter("Fill light", (6.0, 6.0, 6.0)))
    scene.add_object("Fill light", grid((-1.0, 6.0, 3.0), (2.0, 0.0, 0.0), (0.0, 0.0, 2.0)), fill)
    scene.add_camera("Camera", eye, (0.0, 0.0, 0.0), 43.0)
    return scene.glb()


def _wall_with_door(x, z0, z1, height, door_z, door_width, door_height):
    """A wall in the plane x from z0 to z1 with an opening that begins at door_z; it faces +x."""
    end = door_z + door_width
    up = (0.0, height, 0.0)
    over = grid((x, door_height, end), (0.0, 0.0, -door_width), (0.0, height - door_height, 0.0))
    return merged(
        [grid((x, 0.0, door_z), (0.0, 0.0, z0 - door_z), up), grid((x, 0.0, z1), (0.0, 0.0, end - z1), up), over]
    )


def _living_room(scene):
    """Materials of white walls, a varnished floor and a blue wall."""
    return (
        scene.add_material(materials.lambert("White", (0.75, 0.74, 0.70))),
        scene.add_material(materials.glossy("Floor", (0.36, 0.22, 0.12), 0.4)),
        scene.add_material(materials.lambert("Blue", (0.18, 0.28, 0.48))),
    )


def ajar_door():
    """A room whose only light comes through a door that stands ajar [after Veach 1997, 11.4]."""
    scene = Builder("ajar-door")
    white, wood, blue = _living_room(scene)
    room(scene, (-2.0, 0.0, -2.0), (2.0, 2.5, 3.0), (None, white, wood, white, white, blue))
    hinge, width, height, ajar = -1.1, 0.9, 2.05, vec.quaternion(vec.Y, 30.0)
    scene.add_object("Left wall", _wall_with_door(-2.0, -2.0, 3.0, 2.5, hinge, width, height), white)
    scene.add_object(
        "Left wall, far side", _wall_with_door(-2.001, -4.0, 3.0, 2.5, hinge, width, height).flipped(), white
    )
    room(scene, (-5.0, 0.0, -4.0), (-2.001, 2.5, 3.0), (white, None, wood, white, white, white))
    slab = bevel_box((0.04, height - 0.01, width - 0.005), 0.004, 2).moved((0.0, 0.5 * height, 0.5 * width))
    painted = scene.add_material(materials.glossy("Door paint", (0.55, 0.53, 0.48), 0.3))
    scene.add_object("Door", slab, painted, translation=(-2.0, 0.005, hinge), rotation=ajar)
    handle = scene.add_material(materials.metal("Brass", (0.89, 0.70, 0.35), 0.2))
    bent = vec.rotate(ajar, (0.05, 1.0, 0.83))
    scene.add_object("Handle", shapes.sphere(0.03, 32, 16), handle, translation=vec.add((-2.0, 0.005, hinge), bent))
    lamp = scene.add_material(materials.emitter("Ceiling light", (240.0, 225.0, 195.0)))
    scene.add_object("Ceiling light", grid((-4.6, 2.49, -3.4), (2.0, 0.0, 0.0), (0.0, 0.0, 2.0)), lamp)
    scene.add_object("Table", coffee_table(), wood, translation=(0.1, 0.0, -0.7))
    gold = scene.add_material(materials.metal("Gold", (1.0, 0.766, 0.336), 0.2))
    knot = shapes.torus_knot(2, 3, 0.11, 0.05, 0.03, 160, 16)
    scene.add_object("Gold knot", knot, gold, translation=(0.3, 0.50, -0.7))
    glass = scene.add_material(materials.glass("Glass", 1.5, thickness=0.26))
    scene.add_object("Glass sphere", shapes.sphere(0.13, 48, 24), glass, translation=(-0.25, 0.55, -0.65))
    scene.add_object("Chair", chair(), blue, translation=(1.1, 0.0, -0.9), rotation=vec.quaternion(vec.Y, -60.0))
    scene.add_camera("Camera", (1.25, 1.45, 2.6), (-0.45, 0.75, -0.6), 45.0)
    return scene.glb()


def torchiere():
    """A room lit by bounces alone: a floor lamp behind the viewer shines at the ceiling, and at nothing else."""
    scene = Builder("torchiere")
    white = scene.add_material(materials.lambert("White", (0.75, 0.74, 0.70)))
    wood = scene.add_material(materials.lambert("Floor", (0.36, 0.22, 0.12)))
    blue = scene.add_material(materials.lambert("Blue", (0.18, 0.28, 0.48)))
    room(scene, (-2.0, 0.0, -2.0), (2.0, 2.6, 3.0), (white, white, wood, white, white, blue))
    steel = scene.add_material(materials.lambert("Steel", (0.5, 0.5, 0.5)))
    side, depth, at = 0.36, 0.2, (1.3, 1.1, 2.3)
    x, y, z = at
    walls = [
        grid((x, y, z), (side, 0.0, 0.0), (0.0, depth, 0.0)),
        grid((x, y, z + side), (side, 0.0, 0.0), (0.0, depth, 0.0)),
        grid((x, y, z), (0.0, 0.0, side), (0.0, depth, 0.0)),
        grid((x + side, y, z), (0.0, 0.0, side), (0.0, depth, 0.0)),
        grid((x, y, z), (side, 0.0, 0.0), (0.0, 0.0, side)),
    ]
    scene.add_object("Shade", merged(walls), steel)
    pole = shapes.cylinder(0.015, y, 16)
    scene.add_object("Pole", pole, steel, translation=(x + 0.5 * side, 0.0, z + 0.5 * side))
    lamp = scene.add_material(materials.emitter("Lamp", (300.0, 277.0, 237.0)))
    scene.add_object("Lamp", grid((x + 0.03, y + 0.02, z + 0.33), (0.3, 0.0, 0.0), (0.0, 0.0, -0.3)), lamp)
    scene.add_object("Table", coffee_table(), wood, translation=(0.1, 0.0, -0.7))
    brass = scene.add_material(materials.metal("Brushed brass", (0.89, 0.70, 0.35), 0.55))
    knot = shapes.torus_knot(2, 3, 0.11, 0.05, 0.03, 160, 16)
    scene.add_object("Knot", knot, brass, translation=(0.3, 0.50, -0.7))
    scene.add_object("Ball", shapes.sphere(0.13, 48, 24), blue, translation=(-0.25, 0.55, -0.65))
    scene.add_object("Chair", chair(), blue, translation=(1.1, 0.0, -0.9), rotation=vec.quaternion(vec.Y, -60.0))
    scene.add_camera("Camera", (0.9, 1.45, 2.2), (-0.25, 0.55, -0.6), 45.0)
    return scene.glb()


def _column(height=3.2, segments=32):
    """A base, a shaft with entasis and a capital."""
    shaft = [(0.20 - 0.035 * (k / 12.0) ** 1.6, 0.22 + (height - 0.5) * k / 12.0) for k in range(13)]
    top = shaft[-1][1]
    round_base = [(0.21 + 0.055 * math.sin(math.pi * k / 8.0), 0.12 + 0.10 * k / 8.0) for k in range(9)]
    bell = [(0.165 + 0.10 * (k / 8.0) ** 2, top + 0.16 * k / 8.0) for k in range(9)]
    turned = shapes.lathe([round_base, shaft, bell], segments)
    plinth = shapes.box((0.56, 0.12, 0.56)).moved((0.0, 0.06, 0.0))
    abacus = shapes.box((0.58, 0.12, 0.58)).moved((0.0, top + 0.22, 0.0))
    return merged([turned, plinth, abacus])


def colonnade():
    """Two rows of columns under a roof in the sun: long shadows, and light that reaches the walls by bounces only."""
    scene = Builder("colonnade")
    stone = scene.add_material(materials.lambert("Sandstone", (0.72, 0.60, 0.44)))
    paving = scene.add_material(materials.glossy("Paving", (0.52, 0.46, 0.40), 0.35))
    red = scene.add_material(materials.lambert("Red wall", (0.50, 0.14, 0.09)))
    grass = scene.add_material(materials.lambert("Grass", (0.14, 0.24, 0.05)))
    scene.add_object("Ground", grid((-8.0, -0.02, 14.0), (24.0, 0.0, 0.0), (0.0, 0.0, -28.0)), grass)
    scene.add_object("Paving", shapes.box((5.0, 0.04, 17.0)).moved((0.0, 0.0, -1.0)), paving)
    scene.add_object("Wall", shapes.box((0.3, 3.3, 17.0)).moved((-2.35, 1.67, -1.0)), red)
    scene.add_object("Roof", shapes.box((5.4, 0.25, 17.4)).moved((0.0, 3.43, -1.0)), stone)
    column = scene.add_mesh("Column", [(_column(), stone)])
    for row, x in enumerate((-1.45, 1.9)):
        for k in range(8):
            scene.add_node(f"Column {row + 1}.{k + 1}", mesh=column, translation=(x, 0.02, 6.2 - 2.0 * k))
    scene.add_light("Sun", "directional", 6.0, (1.0, 0.93, 0.80), direction=(-0.68, -0.55, -0.28))
    scene.add_camera("Camera", (0.5, 1.65, 6.9), (-0.15, 1.45, 0.0), 52.0)
    return scene.glb()


def thin_furniture():
    """Chairs, tables and a wire shelf: thin legs, contact shadows, small gaps."""
    scene = Builder("thin-furniture")
    white = scene.add_material(materials.lambert("White", (0.74, 0.73, 0.70)))
    floor = scene.add_material(materials.lambert("Floor", (0.42, 0.33, 0.24)))
    room(scene, (-2.4, 0.0, -1.8), (2.4, 2.6, 3.4), (white, white, floor, white, white, white))
    seat = [
        scene.add_material(materials.glossy(name, colour, 0.35))
        for name, colour in (("Yellow", (0.75, 0.48, 0.06)), ("Green", (0.10, 0.32, 0.20)), ("Red", (0.5, 0.07, 0.05)))
    ]
    chairs = [scene.add_mesh(f"Chair {k + 1}", [(chair(), material)]) for k, material in enumerate(seat)]
    places = ((-1.3, 0.1, 50.0), (-0.45, -0.9, 15.0), (0.55, -0.95, -20.0), (1.35, 0.0, -70.0), (0.1, 0.95, 175.0))
    for k, (x, z, turn) in enumerate(places):
        scene.add_node(
            f"Chair {k + 1}", mesh=chairs[k % 3], translation=(x, 0.0, z), rotation=vec.quaternion(vec.Y, turn)
        )
    walnut = scene.add_material(materials.glossy("Walnut", (0.28, 0.15, 0.08), 0.35))
    scene.add_object("Table", coffee_table(1.2, 0.75, 0.72), walnut)
    steel = scene.add_material(materials.metal("Steel wire", (0.6, 0.6, 0.6), 0.3))
    wires = []
    for level in range(5):
        y = 0.12 + 0.42 * level
        wires += [shapes.tube([(-0.45, y, 0.03 * k), (0.45, y, 0.03 * k)], 0.0025, 6) for k in range(11)]
        wires += [shapes.tube([(x, y + 0.003, -0.01), (x, y + 0.003, 0.31)], 0.003, 6) for x in (-0.44, 0.0, 0.44)]
    wires += [shapes.tube([(x, 0.0, z), (x, 1.9, z)], 0.006, 8) for x in (-0.45, 0.45) for z in (0.0, 0.30)]
    scene.add_object("Wire shelf", merged(wires), steel, translation=(1.5, 0.0, -1.72))
    scene.add_light("Lamp", "point", 6.0, (1.0, 0.85, 0.65), (-0.6, 2.1, 0.6))
    panel = scene.add_material(materials.emitter("Window light", (5.0, 5.6, 6.2)))
    scene.add_object("Window light", grid((-2.39, 0.9, 1.4), (0.0, 0.0, -1.4), (0.0, 1.2, 0.0)), panel)
    scene.add_camera("Camera", (0.9, 1.5, 3.1), (0.0, 0.55, -0.3), 46.0)
    return scene.glb()


def _wall_with_window(x, z0, z1, height, low, high):
    """A wall in the plane x from z0 to z1 that faces -x, with an opening between two corners (y, z)."""
    (y0, w0), (y1, w1) = low, high
    parts = ((0.0, height, z0, w0), (0.0, height, w1, z1), (0.0, y0, w0, w1), (y1, height, w0, w1))
    return merged([grid((x, bottom, a), (0.0, 0.0, b - a), (0.0, top - bottom, 0.0)) for bottom, top, a, b in parts])


def sunroom():
    """A room whose only light is the sun behind the two panes of a window."""
    scene = Builder("sunroom")
    white, wood, blue = _living_room(scene)
    room(scene, (-2.0, 0.0, -2.0), (2.0, 2.5, 3.0), (white, None, wood, white, white, blue))
    low, high = (0.8, -1.2), (2.1, 1.0)
    scene.add_object("Right wall", _wall_with_window(2.0, -2.0, 3.0, 2.5, low, high), white)
    bar = bevel_box((0.05, high[0] - low[0], 0.05), 0.004, 2)
    scene.add_object("Bar", bar, white, translation=(2.0, 0.5 * (low[0] + high[0]), -0.1))
    clear = scene.add_material(materials.glass("Window pane", 1.5, thickness=0.0))
    tinted = scene.add_material(materials.glass("Tinted pane", 1.5, colour=(0.55, 0.8, 0.6), thickness=0.0))
    tall = (0.0, high[0] - low[0], 0.0)
    for name, z, pane in (("Left pane", -0.1, clear), ("Right pane", 1.0, tinted)):
        scene.add_object(name, grid((2.0, low[0], z), (0.0, 0.0, -1.1), tall), pane)
    scene.add_object("Table", coffee_table(), wood, translation=(0.1, 0.0, -0.5))
    scene.add_object("Chair", chair(), blue, translation=(-1.1, 0.0, -0.9), rotation=vec.quaternion(vec.Y, 50.0))
    gold = scene.add_material(materials.metal("Gold", (1.0, 0.766, 0.336), 0.2))
    knot = shapes.torus_knot(2, 3, 0.11, 0.05, 0.03, 160, 16)
    scene.add_object("Gold knot", knot, gold, translation=(0.2, 0.50, -0.5))
    scene.add_light("Sun", "directional", 14.0, (1.0, 0.95, 0.85), direction=(-0.72, -0.62, -0.12))
    scene.add_camera("Camera", (-1.5, 1.45, 2.6), (0.6, 0.75, -0.7), 50.0)
    return scene.glb()


def many_lights():
    """A hall under 1,000 small square lamps of several colours, hung at random heights."""
    scene = Builder("many-lights")
    wall = scene.add_material(materials.lambert("Wall", (0.62, 0.60, 0.57)))
    floor = scene.add_material(materials.glossy("Polished floor", (0.30, 0.29, 0.28), 0.25))
    room(scene, (-5.0, 0.0, -12.0), (5.0, 5.0, 8.0), (wall, wall, floor, wall, wall, wall))
    column = scene.add_mesh("Column", [(_column(4.9), wall)])
    for side, x in (("left", -3.2), ("right", 3.2)):
        for k in range(5):
            scene.add_node(f"Column {side} {k + 1}", mesh=column, translation=(x, 0.0, 5.0 - 3.6 * k))
    tints = ((1.0, 0.55, 0.25), (1.0, 0.85, 0.6), (0.5, 0.75, 1.0), (1.0, 0.3, 0.4), (0.45, 1.0, 0.6))
    lamps = [shapes.Mesh() for _ in tints]
    random = Random(81)
    for k in range(1000):
        x, z = -4.6 + 9.2 * ((k % 20) + random.uniform()) / 20.0, -11.5 + 19.0 * ((k // 20) + random.uniform()) / 50.0
        y, size = random.uniform(2.6, 4.7), random.uniform(0.03, 0.07)
        lamps[k % len(tints)].append(grid((x, y, z), (size, 0.0, 0.0), (0.0, 0.0, size)))
    for k, (mesh, tint) in enumerate(zip(lamps, tints)):
        scene.add_object(
            f"Lamps {k + 1}", mesh, scene.add_material(materials.emitter(f"Lamps {k + 1}", vec.scale(tint, 40.0)))
        )
    scene.add_camera("Camera", (0.8, 1.7, 7.2), (0.0, 1.9, 0.0), 55.0)
    return scene.glb()


SCENES = {
    "veach-mis": veach_mis,
    "ajar-door": ajar_door,
    "torchiere": torchiere,
    "colonnade": colonnade,
    "thin-furniture": thin_furniture,
    "sunroom": sunroom,
    "many-lights": many_lights,
}
