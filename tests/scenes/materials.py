"""glTF materials as dictionaries. Colours are linear Rec. 709; radiance is in W/(sr m^2)."""


def _colour(colour):
    return [round(c, 6) for c in colour] + ([1.0] if len(colour) == 3 else [])


def _principled(name, colour, metallic, roughness, extensions=None, **more):
    material = {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": _colour(colour),
            "metallicFactor": metallic,
            "roughnessFactor": roughness,
        },
    }
    if extensions:
        material["extensions"] = extensions
    material.update(more)
    return material


def lambert(name, colour, **more):
    """Exactly albedo / pi: the dielectric highlight is switched off."""
    return _principled(name, colour, 0.0, 1.0, {"KHR_materials_specular": {"specularFactor": 0.0}}, **more)


def glossy(name, colour, roughness, **more):
    """A diffuse base under a dielectric highlight of index 1.5."""
    return _principled(name, colour, 0.0, roughness, **more)


def metal(name, colour, roughness, **more):
    return _principled(name, colour, 1.0, roughness, **more)


def coated(name, colour, roughness, coat=1.0, coat_roughness=0.0, metallic=0.0, **more):
    coat_extension = {"KHR_materials_clearcoat": {"clearcoatFactor": coat, "clearcoatRoughnessFactor": coat_roughness}}
    return _principled(name, colour, metallic, roughness, coat_extension, **more)


def glass(name, ior=1.5, roughness=0.0, colour=(1.0, 1.0, 1.0), tint=None, tint_distance=None, thickness=1.0, **more):
    """A dielectric solid; tint is what white light becomes after tint_distance metres inside."""
    volume = {"thicknessFactor": thickness}
    if tint:
        volume["attenuationColor"] = list(tint)
        volume["attenuationDistance"] = tint_distance
    extensions = {
        "KHR_materials_transmission": {"transmissionFactor": 1.0},
        "KHR_materials_ior": {"ior": ior},
        "KHR_materials_volume": volume,
    }
    return _principled(name, colour, 0.0, roughness, extensions, **more)


def emitter(name, radiance, **more):
    """A black surface that emits radiance (three channels) from its faces."""
    strength = max(radiance)
    extensions = {
        "KHR_materials_specular": {"specularFactor": 0.0},
        "KHR_materials_emissive_strength": {"emissiveStrength": strength},
    }
    factor = [round(c / strength, 9) for c in radiance]
    return _principled(name, (0.0, 0.0, 0.0), 0.0, 1.0, extensions, emissiveFactor=factor, **more)


def with_textures(material, base=None, roughness=None, normal=None, normal_scale=1.0, occlusion=None, transform=None):
    """Adds texture indices to a material; transform is one KHR_texture_transform for all of them."""

    def reference(index, **more):
        out = {"index": index, **more}
        if transform:
            out["extensions"] = {"KHR_texture_transform": dict(transform)}
        return out

    pbr = material["pbrMetallicRoughness"]
    if base is not None:
        pbr["baseColorTexture"] = reference(base)
    if roughness is not None:
        pbr["metallicRoughnessTexture"] = reference(roughness)
    if normal is not None:
        material["normalTexture"] = reference(normal, scale=normal_scale)
    if occlusion is not None:
        material["occlusionTexture"] = reference(occlusion)
    return material
