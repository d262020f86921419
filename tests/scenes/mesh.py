"""A triangle mesh under construction: positions, normals, one UV set, indices. Front faces are counter-clockwise."""

import vec


class Mesh:
    """Vertices are appended with their normal and UV; indices are a flat list, three a triangle."""

    def __init__(self):
        self.positions = []
        self.normals = []
        self.uvs = []
        self.indices = []

    @property
    def triangle_count(self):
        return len(self.indices) // 3

    def vertex(self, position, normal, uv=(0.0, 0.0)):
        self.positions.append(position)
        self.normals.append(normal)
        self.uvs.append(uv)
        return len(self.positions) - 1

    def triangle(self, a, b, c):
        """Adds a triangle unless two of its corners coincide, as they do at the pole of a sphere."""
        pa, pb, pc = self.positions[a], self.positions[b], self.positions[c]
        if pa != pb and pb != pc and pc != pa:
            self.indices += (a, b, c)

    def quad(self, a, b, c, d):
        self.triangle(a, b, c)
        self.triangle(a, c, d)

    def append(self, other):
        """Adds a copy of the other mesh; returns self."""
        base = len(self.positions)
        self.positions += other.positions
        self.normals += other.normals
        self.uvs += other.uvs
        self.indices += [base + i for i in other.indices]
        return self

    def moved(self, translation=(0.0, 0.0, 0.0), rotation=(0.0, 0.0, 0.0, 1.0), scale=1.0):
        """A copy scaled uniformly, then rotated, then translated."""
        out = Mesh()
        out.positions = [vec.add(vec.rotate(rotation, vec.scale(p, scale)), translation) for p in self.positions]
        out.normals = [vec.rotate(rotation, n) for n in self.normals]
        out.uvs = list(self.uvs)
        out.indices = list(self.indices)
        return out

    def flipped(self):
        """A copy turned inside out."""
        out = Mesh()
        out.positions = list(self.positions)
        out.normals = [vec.scale(n, -1.0) for n in self.normals]
        out.uvs = list(self.uvs)
        for i in range(0, len(self.indices), 3):
            a, b, c = self.indices[i : i + 3]
            out.indices += (a, c, b)
        return out

    def with_uvs(self, function):
        """A copy whose UVs are function(uv)."""
        out = self.moved()
        out.uvs = [function(uv) for uv in self.uvs]
        return out


def merged(meshes):
    """One mesh that holds all the given ones."""
    out = Mesh()
    for mesh in meshes:
        out.append(mesh)
    return out


def faceted(mesh):
    """A copy with flat normals and no shared corners: what is seen is then exactly the polyhedron."""
    out = Mesh()
    for i in range(0, len(mesh.indices), 3):
        corners = mesh.indices[i : i + 3]
        a, b, c = (mesh.positions[k] for k in corners)
        normal = vec.normalize(vec.cross(vec.sub(b, a), vec.sub(c, a)))
        out.triangle(*[out.vertex(mesh.positions[k], normal, mesh.uvs[k]) for k in corners])
    return out
