"""The demo scene: the corner of a studio by a window, with an arc lamp over a coffee table. Metres, y up."""

import materials
import shapes
import textures
import vec
from demo_objects import (
    arc_lamp,
    blue_vase,
    book,
    bowl,
    chair,
    coffee_table,
    floor_vase,
    lamp_dome,
    oranges,
    plant_blades,
    plant_pot,
    soil,
    window_frame,
)
from gltf_writer import Builder
from mesh import merged
from shapes import bevel_box, grid

LEFT, RIGHT, BACK, FRONT, HEIGHT = -1.80, 2.20, -1.60, 3.00, 2.60
TABLE = (-0.08, 0.012, -0.30)
TABLE_TOP = TABLE[1] + 0.42
WINDOW_CENTRE, WINDOW_SIZE = (1.42, -0.10), (1.30, 1.30)  # (y, z) on the left wall, (width, height)


def turned(degrees):
    return vec.quaternion(vec.Y, degrees)


def _materials(scene):
    """Every material by its key; textures are made on the way."""
    floor_base, floor_rough, floor_normal = textures.wood_floor()
    metal_rough, metal_normal = textures.brushed_metal()
    planks = scene.add_texture("Oak planks", floor_base)
    planks_rough = scene.add_texture("Oak planks roughness", floor_rough)
    planks_normal = scene.add_texture("Oak planks normals", floor_normal)
    brushed = scene.add_texture("Brushed metal roughness", metal_rough)
    brushed_normal = scene.add_texture("Brushed metal normals", metal_normal)
    rug = scene.add_texture("Rug", textures.rug(), 33071, 33071)
    painting = scene.add_texture("Painting", textures.landscape(), 33071, 33071)

    lambert, glossy, metal, coated, glass = (
        materials.lambert,
        materials.glossy,
        materials.metal,
        materials.coated,
        materials.glass,
    )
    textured = materials.with_textures
    white = (1.0, 1.0, 1.0)
    by_key = {
        "floor": textured(glossy("Oak floor", white, 1.0), planks, planks_rough, planks_normal, 0.8),
        "table": textured(
            glossy("Walnut", (0.52, 0.40, 0.34), 0.42), planks, transform={"scale": [0.42, 0.2], "offset": [0.1, 0.31]}
        ),
        "chair": glossy("Painted wood", (0.045, 0.105, 0.10), 0.32),
        "wall": lambert("Warm plaster", (0.76, 0.71, 0.63)),
        "accent": lambert("Teal wall", (0.075, 0.235, 0.25)),
        "ceiling": lambert("Ceiling white", (0.80, 0.79, 0.77)),
        "trim": glossy("Trim white", (0.78, 0.77, 0.74), 0.35),
        "rug": textured(lambert("Rug", white), rug),
        "painting": textured(lambert("Painting", white), painting),
        "frame": metal("Brass frame", (0.80, 0.60, 0.30), 0.32),
        "mat": lambert("Picture mat", (0.82, 0.80, 0.75)),
        "gold": metal("Gold", (1.0, 0.766, 0.336), 0.16),
        "copper": textured(metal("Brushed copper", (0.955, 0.60, 0.46), 1.0), None, brushed, brushed_normal),
        "steel": metal("Steel", (0.60, 0.59, 0.57), 0.22),
        "dome": coated("Black lacquer", (0.012, 0.012, 0.013), 0.5, 1.0, 0.08),
        "dome inside": lambert("Dome inside", (0.34, 0.31, 0.25)),
        "marble": coated("Marble", (0.70, 0.69, 0.67), 0.4, 0.7, 0.1),
        "plinth": glossy("Slate", (0.055, 0.06, 0.068), 0.45),
        "blue glass": glass("Blue glass", 1.5, 0.0, tint=(0.10, 0.34, 0.80), tint_distance=0.006, thickness=0.01),
        "clear glass": glass("Clear glass", 1.5, 0.0, tint=(0.93, 0.98, 0.96), tint_distance=0.2, thickness=0.15),
        "glaze": coated("Terracotta glaze", (0.56, 0.15, 0.065), 0.55, 0.9, 0.06),
        "celadon": coated("Celadon", (0.42, 0.56, 0.47), 0.5, 1.0, 0.03),
        "orange": glossy("Orange peel", (0.90, 0.29, 0.015), 0.38),
        "leaf": glossy("Leaf", (0.055, 0.19, 0.045), 0.42, doubleSided=True),
        "soil": lambert("Soil", (0.05, 0.033, 0.022)),
        "paper": lambert("Paper", (0.78, 0.73, 0.62)),
        "cover rust": glossy("Rust cover", (0.42, 0.085, 0.04), 0.5),
        "cover cream": glossy("Cream cover", (0.72, 0.62, 0.43), 0.5),
        "cover navy": glossy("Navy cover", (0.025, 0.05, 0.13), 0.45),
        "window": materials.emitter("Window light", (8.8, 10.4, 11.8)),
    }
    return {key: scene.add_material(material) for key, material in by_key.items()}


def _room(scene, material):
    wide, deep = RIGHT - LEFT, FRONT - BACK
    x, y, z = (wide, 0.0, 0.0), (0.0, HEIGHT, 0.0), (0.0, 0.0, deep)
    back = vec.scale(z, -1.0)
    scene.add_object("Floor", grid((LEFT, 0.0, FRONT), x, back, uv_scale=(wide / 2.4, deep / 1.2)), material["floor"])
    scene.add_object("Ceiling", grid((LEFT, HEIGHT, BACK), x, z), material["ceiling"])
    scene.add_object("Back wall", grid((LEFT, 0.0, BACK), x, y), material["wall"])
    scene.add_object("Front wall", grid((RIGHT, 0.0, FRONT), vec.scale(x, -1.0), y), material["wall"])
    scene.add_object("Left wall", grid((LEFT, 0.0, FRONT), back, y), material["accent"])
    scene.add_object("Right wall", grid((RIGHT, 0.0, BACK), z, y), material["wall"])
    tall, thick = 0.11, 0.018
    along_back = bevel_box((wide, tall, thick), 0.006, 2).moved((0.5 * (LEFT + RIGHT), 0.5 * tall, BACK + 0.5 * thick))
    sides = [
        bevel_box((thick, tall, deep), 0.006, 2).moved((side, 0.5 * tall, 0.5 * (BACK + FRONT)))
        for side in (LEFT + 0.5 * thick, RIGHT - 0.5 * thick)
    ]
    scene.add_object("Skirting", merged([along_back] + sides), material["trim"])


def _window(scene, material):
    wide, tall = WINDOW_SIZE
    place = {"translation": (LEFT, *WINDOW_CENTRE), "rotation": turned(90.0)}
    pane = grid((-0.5 * wide, -0.5 * tall, 0.012), (wide, 0.0, 0.0), (0.0, tall, 0.0))
    scene.add_object("Window light", pane, material["window"], **place)
    scene.add_object("Window frame", window_frame(wide, tall), material["trim"], **place)


def _picture(scene, material):
    place = (-0.62, 1.42, BACK)
    canvas = grid((-0.20, -0.24, 0.012), (0.40, 0.0, 0.0), (0.0, 0.48, 0.0))
    mat = grid((-0.28, -0.32, 0.010), (0.56, 0.0, 0.0), (0.0, 0.64, 0.0))
    scene.add_object(
        "Picture frame", shapes.picture_frame(0.56, 0.64, 0.03, 0.03), material["frame"], translation=place
    )
    scene.add_object("Painting", [(canvas, material["painting"]), (mat, material["mat"])], translation=place)


def _furniture(scene, material):
    rug = bevel_box((1.90, 0.012, 1.42), 0.005, 2).moved((0.0, 0.006, 0.0))
    rug = rug.with_uvs(lambda uv: (uv[0] / 1.90, uv[1] / 1.42))
    scene.add_object("Rug", rug, material["rug"], translation=(-0.08, 0.0, -0.22), rotation=turned(3.0))
    scene.add_object("Coffee table", coffee_table(), material["table"], translation=TABLE, rotation=turned(3.0))
    scene.add_object("Chair", chair(), material["chair"], translation=(0.96, 0.0, -0.70), rotation=turned(-62.0))
    base, arc, end = arc_lamp(1.15, 2.02, 0.10)
    foot, towards = (1.22, 0.0, -1.25), -142.0
    stand = [(base, material["marble"]), (arc, material["steel"])]
    scene.add_object("Arc lamp", stand, translation=foot, rotation=turned(towards))
    hang = vec.add(foot, vec.rotate(turned(towards), end))
    outside, inside = lamp_dome()
    rim = vec.sub(hang, (0.0, 0.17, 0.0))
    scene.add_object("Lamp shade", [(outside, material["dome"]), (inside, material["dome inside"])], translation=rim)
    scene.add_light("Lamp", "point", 8.0, (1.0, 0.72, 0.42), vec.add(rim, (0.0, 0.045, 0.0)))


def _on_the_table(scene, material):
    def put(name, parts, key, x, z, degrees=0.0, lift=0.0):
        place = vec.add(vec.rotate(turned(3.0), (x, 0.0, z)), (TABLE[0], TABLE_TOP + lift, TABLE[2]))
        scene.add_object(name, parts, key and material[key], translation=place, rotation=turned(degrees))

    put("Blue vase", blue_vase(), "blue glass", -0.36, -0.10)
    put("Glass ball", shapes.sphere(0.062, 48, 24), "clear glass", -0.20, 0.13, lift=0.062)
    put("Bowl", bowl(), "celadon", 0.06, 0.12)
    put("Oranges", oranges(), "orange", 0.06, 0.12)
    lift = 0.0
    for name, size, key, degrees in (
        ("Navy book", (0.19, 0.27, 0.034), "cover navy", 14.0),
        ("Cream book", (0.17, 0.25, 0.026), "cover cream", 4.0),
        ("Rust book", (0.15, 0.215, 0.022), "cover rust", 24.0),
    ):
        cover, pages = book(*size)
        put(name, [(cover, material[key]), (pages, material["paper"])], None, 0.38, -0.02, degrees, lift)
        lift += size[2]
    put("Copper ball", shapes.sphere(0.036, 32, 16), "copper", 0.37, -0.02, 30.0, lift + 0.036)
    put("Plinth", bevel_box((0.12, 0.05, 0.12), 0.006, 2).moved((0.0, 0.025, 0.0)), "plinth", 0.02, -0.16, 20.0)
    knot = shapes.torus_knot(2, 3, 0.070, 0.032, 0.0165, 180, 16).moved((0.0, 0.0, 0.0), vec.quaternion(vec.X, 78.0))
    put("Gold knot", knot, "gold", 0.02, -0.16, 32.0, 0.05 + 0.116)


def _on_the_floor(scene, material):
    corner = (-1.32, 0.0, -1.12)
    pot = [(plant_pot(), material["copper"]), (soil(), material["soil"])]
    scene.add_object("Copper pot", pot, translation=corner)
    scene.add_object("Plant", plant_blades(), material["leaf"], translation=vec.add(corner, (0.0, 0.24, 0.0)))
    scene.add_object("Floor vase", floor_vase(), material["glaze"], translation=(-0.72, 0.0, -1.26))


def demo():
    scene = Builder("Studio corner")
    material = _materials(scene)
    _room(scene, material)
    _window(scene, material)
    _picture(scene, material)
    _furniture(scene, material)
    _on_the_table(scene, material)
    _on_the_floor(scene, material)
    scene.add_camera("Camera", (0.94, 1.32, 2.24), (-0.05, 0.80, -0.50), 38.0, 4.0 / 3.0)
    return scene.glb()


SCENES = {"demo": demo}
