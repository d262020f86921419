"""White furnaces: a body under uniform radiance 1. Bodies are faceted, so that no shading normal spoils the closed
form.

The surroundings are a closed emitter of radiance 1; whatever its tessellation, every ray that reaches it brings 1.
"""

import functools

import materials
import shapes
from gltf_writer import Builder
from mesh import faceted

WHITE = (1.0, 1.0, 1.0)


def _furnace(name, material, body=None):
    """A unit sphere (or another body) in the furnace. Pixels past the body are 1."""
    scene = Builder(name)
    surroundings = faceted(shapes.sphere(10.0, 16, 8).flipped())
    scene.add_object("Surroundings", surroundings, scene.add_material(materials.emitter("Radiance 1", WHITE)))
    scene.add_object("Body", body or faceted(shapes.sphere(1.0, 64, 32)), scene.add_material(material))
    scene.add_camera("Camera", (0.0, 0.0, 4.0), (0.0, 0.0, 0.0), 36.0)
    return scene.glb()


def furnace_diffuse(albedo, name):
    """Every pixel of the body is albedo."""
    return _furnace(name, materials.lambert("Diffuse", (albedo,) * 3))


def furnace_ggx(step, name):
    """A metal of F0 = 1: the body shows the directional albedo of single-scattering GGX; 1 at roughness 0."""
    return _furnace(name, materials.metal(f"GGX roughness {step / 10:.1f}", WHITE, step / 10.0))


def furnace_dielectric():
    """Smooth glass that absorbs nothing: every pixel is 1, however often a path is reflected inside."""
    return _furnace("furnace-dielectric", materials.glass("Glass", 1.5, thickness=2.0))


def furnace_rough_dielectric():
    """Rough glass: at most 1, and 1 up to what single scattering loses."""
    return _furnace("furnace-rough-dielectric", materials.glass("Rough glass", 1.5, 0.3, thickness=2.0))


def furnace_clearcoat():
    """A coat over white: at most 1."""
    return _furnace("furnace-clearcoat", materials.coated("Coated white", WHITE, 1.0))


def furnace_closed():
    """The inside of a closed sphere of albedo 1/2 that emits 1/2: radiance is 1/2 + 1/2 * 1/2 + ... = 1 everywhere."""
    scene = Builder("furnace-closed")
    glow = materials.lambert("Glowing grey", (0.5, 0.5, 0.5), emissiveFactor=[0.5, 0.5, 0.5])
    scene.add_object("Inside", faceted(shapes.sphere(1.0, 32, 16).flipped()), scene.add_material(glow))
    scene.add_camera("Camera", (0.0, 0.0, 0.3), (0.0, 0.0, -1.0), 60.0)
    return scene.glb()


SCENES = {
    "furnace-diffuse-05": functools.partial(furnace_diffuse, 0.5, "furnace-diffuse-05"),
    "furnace-diffuse-1": functools.partial(furnace_diffuse, 1.0, "furnace-diffuse-1"),
    **{f"furnace-ggx-{k:02d}": functools.partial(furnace_ggx, k, f"furnace-ggx-{k:02d}") for k in range(11)},
    "furnace-dielectric": furnace_dielectric,
    "furnace-rough-dielectric": furnace_rough_dielectric,
    "furnace-clearcoat": furnace_clearcoat,
    "furnace-closed": furnace_closed,
}
