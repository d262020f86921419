"""A gallery: one exhibit for each way glTF can store or map a surface. Columns of six, from the top left; node names
say what each is."""

import exhibits_geometry as geometry
import materials
import shapes
import textures
import vec
from gltf_writer import Builder

REPEAT, CLAMP, MIRROR = 10497, 33071, 33648
NEAREST, LINEAR = 9728, 9729
COLUMNS, SPACING = 6, 1.0
GREY = (0.6, 0.6, 0.6)
WHITE = (1.0, 1.0, 1.0)


def _textured(scene, name, texture, transform=None, **more):
    return scene.add_material(
        materials.with_textures(materials.lambert(name, WHITE, **more), texture, transform=transform)
    )


def _panel(material, uv=1.0, shift=0.0):
    """An exhibit that is a plain panel whose UVs run from shift to shift + uv."""

    def add(scene, name, _):
        mesh = geometry.panel(1, uv).with_uvs(lambda c: (c[0] + shift, c[1] + shift))
        return {"mesh": scene.add_mesh(name, [(mesh, material)])}

    return add, None


def _wraps(scene, picture):
    modes = (
        ("repeat", REPEAT, REPEAT),
        ("clamp", CLAMP, CLAMP),
        ("mirror", MIRROR, MIRROR),
        ("repeat and clamp", REPEAT, CLAMP),
    )
    for name, u, v in modes:
        texture = scene.add_texture(f"Wrap {name}", picture, u, v)
        yield f"Wrap {name}", _panel(_textured(scene, f"Wrap {name}", texture), 3.0, -1.0)


def _mappings(scene, picture):
    texture = scene.add_texture("Letter", picture)
    nearest = scene.add_texture(
        "Letter, nearest",
        textures.checker(4, 4, 4, 4, (0.9, 0.2, 0.1), (0.1, 0.2, 0.8)),
        magnify=NEAREST,
        minify=NEAREST,
    )
    smooth = scene.add_texture(
        "Letter, linear", textures.checker(4, 4, 4, 4, (0.9, 0.2, 0.1), (0.1, 0.2, 0.8)), magnify=LINEAR
    )
    yield "Nearest", _panel(_textured(scene, "Nearest", nearest))
    yield "Linear", _panel(_textured(scene, "Linear", smooth))
    yield "Transform scale", _panel(_textured(scene, "Transform scale", texture, {"scale": [2.0, 3.0]}))
    yield "Transform offset", _panel(_textured(scene, "Transform offset", texture, {"offset": [0.25, 0.5]}))
    turn = {"rotation": 0.5235987755982988, "offset": [0.1, 0.2], "scale": [1.5, 1.5]}
    yield "Transform rotation", _panel(_textured(scene, "Transform rotation", texture, turn))
    second = materials.with_textures(materials.lambert("Second UV", WHITE), texture)
    second["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1
    yield "Second UV", (geometry.second_uv, scene.add_material(second))
    override = materials.with_textures(
        materials.lambert("Transform UV set", WHITE), texture, transform={"texCoord": 1, "scale": [1.0, 1.0]}
    )
    yield "Transform UV set", (geometry.second_uv, scene.add_material(override))


def _surfaces(scene, picture):
    letter = scene.add_texture("Letter on surfaces", picture)
    yield "Vertex colours", (geometry.vertex_colours, scene.add_material(materials.lambert("Vertex colours", WHITE)))
    yield "Double sided", _panel(_textured(scene, "Double sided", letter, doubleSided=True))
    yield "Alpha blend", _panel(
        scene.add_material(materials.lambert("Alpha blend", (0.9, 0.3, 0.1, 0.5), alphaMode="BLEND"))
    )
    leaf = scene.add_texture("Leaf", textures.leaf(128), CLAMP, CLAMP)
    yield "Alpha mask", _panel(
        _textured(scene, "Alpha mask", leaf, alphaMode="MASK", alphaCutoff=0.5, doubleSided=True)
    )
    unlit = materials.with_textures(materials.lambert("Unlit", GREY), letter)
    unlit["extensions"] = {"KHR_materials_unlit": {}}
    yield "Unlit", _panel(scene.add_material(unlit))
    waves = textures.normal_map(
        [[0.6 * ((x // 8) % 2) + 0.4 * ((y // 8) % 2) for x in range(64)] for y in range(64)], 1.0
    )
    bumps = scene.add_texture("Bumps", waves)
    yield "Tangents", (
        geometry.tangents,
        scene.add_material(materials.with_textures(materials.glossy("Bumps", GREY, 0.3), normal=bumps)),
    )
    yield "No tangents", _panel(
        scene.add_material(materials.with_textures(materials.glossy("Bumps too", GREY, 0.3), normal=bumps))
    )
    steps = textures.picture(4, 4, lambda x, y: (1.0, 0.1 + 0.25 * x, y / 3.0))
    rough = scene.add_texture("Roughness and metal", steps, CLAMP, CLAMP, NEAREST, NEAREST)
    mixed = materials.with_textures(materials.metal("Roughness and metal", (0.95, 0.7, 0.4), 1.0), roughness=rough)
    yield "Roughness and metal", _panel(scene.add_material(mixed))
    glow = materials.lambert(
        "Emissive texture", (0.0, 0.0, 0.0), emissiveFactor=[1.0, 1.0, 1.0], emissiveTexture={"index": letter}
    )
    yield "Emissive texture", _panel(scene.add_material(glow))


def _storage(scene, picture):
    letter = _textured(scene, "Letter", scene.add_texture("Letter on meshes", picture))
    grey = scene.add_material(materials.lambert("Grey", GREY, doubleSided=True))
    for name, add in (
        ("Sparse accessor", geometry.sparse),
        ("Interleaved", geometry.interleaved),
        ("Quantized", geometry.quantized),
        ("Triangle strip", geometry.strip),
        ("Triangle fan", geometry.fan),
        ("Morph targets", geometry.morphed),
        ("Skin", geometry.skinned),
    ):
        yield name, (add, letter if add in (geometry.interleaved, geometry.quantized) else grey)


def _place(scene, index, name, exhibit):
    add, material = exhibit
    node = add(scene, name, material)
    node.setdefault("translation", _position(index))
    if name == "Double sided":
        node["rotation"] = vec.quaternion(vec.Y, 180.0)
    scene.add_node(name, **node)


def _position(index):
    return (SPACING * (index % COLUMNS - 0.5 * (COLUMNS - 1)), SPACING * (2.0 - index // COLUMNS), 0.2)


def gallery():
    scene = Builder("textures")
    picture = textures.letter_f()
    wall = scene.add_texture("Wall", textures.checker(64, 64, 8, 8, (0.42, 0.42, 0.44), (0.50, 0.50, 0.52)))
    backdrop = shapes.grid((-4.0, -4.0, 0.0), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0), uv_scale=(4.0, 4.0))
    scene.add_object("Wall", backdrop, _textured(scene, "Wall", wall))
    exhibits = [exhibit for part in (_wraps, _mappings, _surfaces, _storage) for exhibit in part(scene, picture)]
    for index, (name, exhibit) in enumerate(exhibits):
        _place(scene, index, name, exhibit)
    letter = _textured(scene, "Negative scale", scene.add_texture("Letter, mirrored", picture))
    mesh = scene.add_mesh("Negative scale", [(geometry.panel(), letter)])
    scene.add_node("Negative scale", mesh=mesh, translation=_position(len(exhibits)), scale=[-1.0, 1.0, 1.0])
    x, y, z = _position(len(exhibits) + 1)
    sheared = [0.8, 0.0, 0.0, 0.0, 0.4, 0.8, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0]
    scene.add_node("Matrix with shear", mesh=mesh, matrix=sheared)
    scene.add_light("Lamp", "point", 45.0, (1.0, 0.95, 0.9), (-2.0, 2.5, 4.0))
    panel = scene.add_material(materials.emitter("Panel", (3.0, 3.0, 3.0)))
    scene.add_object("Panel", shapes.grid((3.0, -1.0, 6.0), (0.0, 2.0, 0.0), (2.0, 0.0, 0.0)), panel)
    scene.add_camera("Camera", (0.0, 0.0, 7.5), (0.0, 0.0, 0.0), 44.0)
    return scene.glb()


SCENES = {"textures": gallery}
