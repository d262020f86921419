"""Scenes whose picture has a closed form. Diffuse surfaces have albedo 1/2, so reflected radiance is irradiance / (2
pi)."""

import math

import hdr
import materials
import shapes
from gltf_writer import Builder
from mesh import faceted

GREY = (0.5, 0.5, 0.5)
EYE, TARGET = (0.0, 1.6, 2.6), (0.0, 0.0, 0.0)
SPOT_INNER, SPOT_OUTER = 0.35, 0.60  # half angles [rad]
SUN_TEXEL, SUN_RADIANCE = (20, 5), 5000.0
SUN_DIRECTION = (0.5, -math.sqrt(0.5), -0.5)  # unit length, 45 degrees above the horizon


def _over_a_plane(name, size=4.0):
    """A diffuse square of the given size in y = 0, seen from one side."""
    scene = Builder(name)
    plane = shapes.grid((-0.5 * size, 0.0, 0.5 * size), (size, 0.0, 0.0), (0.0, 0.0, -size))
    scene.add_object("Plane", plane, scene.add_material(materials.lambert("Half", GREY)))
    scene.add_camera("Camera", EYE, TARGET, 45.0)
    return scene


def analytic_point():
    """Point of I = 1 W/sr at height h = 1: L = I h / (2 pi d^3), d the distance from the light."""
    scene = _over_a_plane("analytic-point")
    scene.add_light("Point", "point", 1.0, position=(0.0, 1.0, 0.0))
    return scene.glb()


def analytic_spot():
    """The point's radiance times clamp(cos(a) s + o)^2, with s = 1 / max(0.001, cos(inner) - cos(outer)) and
    o = -cos(outer) s [KHR_lights_punctual]."""
    scene = _over_a_plane("analytic-spot")
    cone = {"innerConeAngle": SPOT_INNER, "outerConeAngle": SPOT_OUTER}
    scene.add_light("Spot", "spot", 1.0, position=(0.0, 1.0, 0.0), direction=(0.0, -1.0, 0.0), spot=cone)
    return scene.glb()


def analytic_sun():
    """Directional light of E = 1 W/m^2 across its direction, at 45 degrees: L = sqrt(1/2) / (2 pi)."""
    scene = _over_a_plane("analytic-sun")
    scene.add_light("Sun", "directional", 1.0, direction=SUN_DIRECTION)
    return scene.glb()


def analytic_quad():
    """A square emitter of side 1 and L = 5 at height 1, facing down: irradiance is L/2 sum_i angle_i (n_i . up) over
    its edges [Lambert's polygon formula]."""
    scene = _over_a_plane("analytic-quad", 6.0)
    emitter = shapes.grid((-0.5, 1.0, -0.5), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    scene.add_object("Emitter", emitter, scene.add_material(materials.emitter("Radiance 5", (5.0, 5.0, 5.0))))
    return scene.glb()


def analytic_sphere():
    """A point of I = 1 W/sr at the centre of a closed sphere of radius 1: E = 1 + E/2, so L = 1 / pi, half of it
    indirect. The sphere is a polyhedron within 6e-4 of the radius."""
    scene = Builder("analytic-sphere")
    inside = faceted(shapes.sphere(1.0, 128, 64).flipped())
    scene.add_object("Inside", inside, scene.add_material(materials.lambert("Half", GREY)))
    scene.add_light("Point", "point", 1.0, position=(0.0, 0.0, 0.0))
    scene.add_camera("Camera", (0.0, 0.3, 0.6), (0.0, 0.0, -1.0), 60.0)
    return scene.glb()


def black_box():
    """A closed black box with lights outside, seen from within: every pixel is exactly 0."""
    scene = Builder("black-box")
    black = scene.add_material(materials.lambert("Black", (0.0, 0.0, 0.0)))
    scene.add_object("Box", shapes.box((2.0, 2.0, 2.0)).flipped(), black)
    scene.add_light("Point", "point", 100.0, position=(0.0, 3.0, 0.0))
    scene.add_light("Sun", "directional", 100.0, direction=SUN_DIRECTION)
    panel = shapes.grid((-1.0, 2.0, -1.0), (2.0, 0.0, 0.0), (0.0, 0.0, 2.0))
    scene.add_object("Panel", panel, scene.add_material(materials.emitter("Panel", (50.0, 50.0, 50.0))))
    scene.add_camera("Camera", (0.0, 0.0, 0.9), (0.0, 0.0, 0.0), 60.0)
    return scene.glb()


def analytic_refraction():
    """A glass slab over a plane that emits 1: seen through both faces the plane still brings 1, the rest is dark, so
    a pixel is the slab's transmittance (1 - R) / (1 + R), with R the Fresnel reflectance at the pixel's angle."""
    scene = Builder("analytic-refraction")
    plane = shapes.grid((-4.0, 0.0, 4.0), (8.0, 0.0, 0.0), (0.0, 0.0, -8.0))
    scene.add_object("Plane", plane, scene.add_material(materials.emitter("Radiance 1", (1.0, 1.0, 1.0))))
    slab = shapes.box((4.0, 0.2, 4.0)).moved((0.0, 0.6, 0.0))
    scene.add_object("Slab", slab, scene.add_material(materials.glass("Glass", 1.5, thickness=0.2)))
    scene.add_camera("Camera", (0.0, 2.0, 1.6), (0.0, 0.6, 0.0), 30.0)
    return scene.glb()


def analytic_sky():
    """The plane under analytic-sky.hdr and nothing else: L is 1/(2 pi) of the integral of the sky's radiance times the
    cosine over the upper hemisphere. The sun is one texel, ten thousand times as bright as the sky at the horizon."""
    scene = _over_a_plane("analytic-sky", 20.0)
    scene.document["extras"] = {"limn": {"environment": "analytic-sky.hdr"}}
    return scene.glb()


def analytic_sky_image():
    """64x32 texels; bluer towards the top, black below the horizon."""

    def colour(x, y):
        if (x, y) == SUN_TEXEL:
            return (SUN_RADIANCE,) * 3
        height = max(0.0, 1.0 - y / 16.0)
        return (0.5, 0.5, 0.5 + 0.5 * height) if y < 16 else (0.0, 0.0, 0.0)

    return hdr.encode(64, 32, colour)


SCENES = {
    "analytic-point": analytic_point,
    "analytic-spot": analytic_spot,
    "analytic-sun": analytic_sun,
    "analytic-quad": analytic_quad,
    "analytic-sphere": analytic_sphere,
    "analytic-sky": analytic_sky,
    "analytic-refraction": analytic_refraction,
    "black-box": black_box,
}
# Files that a scene names, beside its GLB.
FILES = {"analytic-sky": {"analytic-sky.hdr": analytic_sky_image}}
