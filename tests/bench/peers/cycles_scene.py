"""Runs inside Blender 3.4: imports a GLB, makes it mean in Cycles what it means in glTF, and renders it.

Image values are radiance. A point light of I W/sr is 4 pi I watts to Blender, a directional light of E W/m² has
strength E. Diffuse is Lambert, GGX is single scattering, emitters shine from both faces. The pixel filter is a box of
one pixel; nothing is clamped, filtered or denoised. Large emitters are cut into pieces: Cycles samples near triangles
by an approximation of their solid angle that is up to 1 % too dark.
"""
import json
import math
import pathlib
import struct
import sys
import time

import bmesh
import bpy
import numpy

numpy.bool = bool  # the importer of Debian 12's Blender was written for an older NumPy
PIECES = 12  # along each edge of an emitter
FEW_FACES = 16  # an emitter of more faces is fine enough
UNDERSTOOD = {"KHR_materials_specular", "KHR_materials_emissive_strength", "KHR_materials_ior"}


class NotTranslated(Exception):
    """The scene uses something that would look different; the text says what."""


def read_document(path):
    data = path.read_bytes()
    (length,) = struct.unpack("<I", data[12:16])
    return json.loads(data[20 : 20 + length])


def check(document):
    for material in document.get("materials", []):
        unknown = set(material.get("extensions", {})) - UNDERSTOOD
        pbr = material.get("pbrMetallicRoughness", {})
        if unknown:
            raise NotTranslated(", ".join(sorted(unknown)))
        if material.get("alphaMode", "OPAQUE") != "OPAQUE":
            raise NotTranslated("alpha")
        textures = [key for holder in (material, pbr) for key in holder if key.endswith("Texture")]
        if textures:
            raise NotTranslated(", ".join(textures))
        if 0.0 < pbr.get("metallicFactor", 1.0) < 1.0:
            raise NotTranslated("partly metallic materials")
    for light in lights_of(document):
        if light["type"] == "spot":
            raise NotTranslated("spot lights")


def lights_of(document):
    return document.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])


def set_lights(document):
    """Energy from the file itself, whatever the importer made of it; importer and file agree on the node's name."""
    lights = lights_of(document)
    for node in document.get("nodes", []):
        index = node.get("extensions", {}).get("KHR_lights_punctual", {}).get("light")
        if index is None:
            continue
        data, light = bpy.data.objects[node["name"]].data, lights[index]
        scale = 4.0 * math.pi if light["type"] == "point" else 1.0
        data.energy = light.get("intensity", 1.0) * scale
        data.color = light.get("color", [1.0, 1.0, 1.0])
        if light["type"] == "point":
            data.shadow_soft_size = 0.0
        else:
            data.angle = 0.0


def shader(tree, kind, **inputs):
    node = tree.nodes.new(kind)
    for name, value in inputs.items():
        node.inputs[name.replace("_", " ")].default_value = value
    return node


def opaque(colour):
    return (*colour[:3], 1.0)


def metal(tree, colour, roughness):
    node = shader(tree, "ShaderNodeBsdfPrincipled", Base_Color=opaque(colour), Metallic=1.0, Roughness=roughness)
    node.distribution = "GGX"
    return node


def dielectric(tree, colour, roughness, ior, specular):
    """Lambert under a Fresnel-weighted GGX lobe; pure Lambert when `specular` is 0."""
    diffuse = shader(tree, "ShaderNodeBsdfDiffuse", Color=opaque(colour), Roughness=0.0)
    if specular == 0.0:
        return diffuse
    gloss = shader(tree, "ShaderNodeBsdfGlossy", Color=(1.0, 1.0, 1.0, 1.0), Roughness=roughness)
    gloss.distribution = "GGX"
    fresnel = shader(tree, "ShaderNodeFresnel", IOR=ior)
    weight = shader(tree, "ShaderNodeMath")
    weight.operation = "MULTIPLY"
    weight.inputs[1].default_value = specular
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(fresnel.outputs[0], weight.inputs[0])
    tree.links.new(weight.outputs[0], mix.inputs[0])
    tree.links.new(diffuse.outputs[0], mix.inputs[1])
    tree.links.new(gloss.outputs[0], mix.inputs[2])
    return mix


def rebuild(material, source):
    """The nodes of `material` anew from the glTF material `source`."""
    extensions, pbr = source.get("extensions", {}), source.get("pbrMetallicRoughness", {})
    colour, roughness = pbr.get("baseColorFactor", [1.0] * 4), pbr.get("roughnessFactor", 1.0)
    strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
    emission = [strength * c for c in source.get("emissiveFactor", [0.0] * 3)]
    ior = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
    specular = extensions.get("KHR_materials_specular", {}).get("specularFactor", 1.0)

    tree = material.node_tree
    tree.nodes.clear()
    metallic = pbr.get("metallicFactor", 1.0) == 1.0
    surface = metal(tree, colour, roughness) if metallic else dielectric(tree, colour, roughness, ior, specular)
    if any(emission):
        lamp = shader(tree, "ShaderNodeEmission", Color=opaque(emission), Strength=1.0)
        both = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(surface.outputs[0], both.inputs[0])
        tree.links.new(lamp.outputs[0], both.inputs[1])
        surface = both
    tree.links.new(surface.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    material.use_backface_culling = False
    return any(emission)


def set_materials(document):
    emitters = set()
    for source in document.get("materials", []):
        material = bpy.data.materials.get(source["name"])
        if material and rebuild(material, source):
            emitters.add(material.name)
    for mesh in bpy.data.meshes:
        used = {slot.name for slot in mesh.materials if slot}
        if used & emitters and len(mesh.polygons) <= FEW_FACES:
            cut(mesh)


def cut(mesh):
    pieces = bmesh.new()
    pieces.from_mesh(mesh)
    bmesh.ops.subdivide_edges(pieces, edges=pieces.edges[:], cuts=PIECES - 1, use_grid_fill=True)
    pieces.to_mesh(mesh)
    pieces.free()


def set_camera(scene, document):
    camera = next(ob for ob in bpy.data.objects if ob.type == "CAMERA")
    lens = document["cameras"][0]["perspective"]
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle_y = lens["yfov"]
    camera.data.clip_start = max(lens["znear"], 1e-4)
    camera.data.clip_end = 1e5
    scene.camera = camera


def set_renderer(scene, size):
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.render.use_persistent_data = True
    image = scene.render.image_settings
    image.file_format, image.color_mode, image.color_depth, image.exr_codec = "OPEN_EXR", "RGB", "32", "ZIP"
    scene.view_settings.view_transform = "Raw"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, "max_bounces" if kind == "max" else f"{kind}_bounces", 64)
    scene.world = bpy.data.worlds.new("Black")
    scene.world.use_nodes = False
    scene.world.color = (0.0, 0.0, 0.0)


def render(scene, samples, path):
    """Seconds of rendering with the scene loaded; writing does not count."""
    scene.cycles.samples = samples
    scene.update_tag()  # or the data that are kept keep the number of samples too
    begin = time.perf_counter()
    bpy.ops.render.render()
    seconds = time.perf_counter() - begin
    bpy.data.images["Render Result"].save_render(str(path), scene=scene)
    return seconds


def run(job):
    path = pathlib.Path(job["scene"])
    document = read_document(path)
    check(document)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    scene = bpy.context.scene
    set_lights(document)
    set_materials(document)
    set_camera(scene, document)
    set_renderer(scene, job["size"])
    output = pathlib.Path(job["output"])
    render(scene, 1, output / f"{path.stem}.warm.exr")  # the scene and its BVH are kept for those that count
    pictures = []
    for samples in job["samples"]:
        name = f"{path.stem}.cycles.{samples}.exr"
        pictures.append({"seconds": render(scene, samples, output / name), "file": name})
    return pictures


try:
    answer = {"pictures": run(json.loads(sys.argv[sys.argv.index("--") + 1]))}
except NotTranslated as problem:
    answer = {"reason": f"not translated: {problem}"}
print("cycles-result: " + json.dumps(answer), flush=True)
