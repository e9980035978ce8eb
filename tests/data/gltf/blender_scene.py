"""Makes blender.glb, blender.obj, blender.mtl and blender_checker.png, by Blender 3.4:

    blender -b --factory-startup --python blender_scene.py -- FOLDER

One scene in both formats: a textured box, a half-metallic ball as child of a turned and stretched
empty, a mirrored cone without smooth normals, a sun, a spot and a camera.
"""
import math
import sys
from pathlib import Path

import bmesh
import bpy

folder = Path(sys.argv[-1]).resolve()
bpy.ops.wm.read_factory_settings(use_empty=True)

picture = bpy.data.images.new("blender_checker", 8, 8)
picture.pixels = [c for i in range(64) for c in ((1, 0.5, 0, 1) if (i // 8 + i) % 2 else (0, 0.25, 1, 1))]
picture.filepath_raw, picture.file_format = str(folder / "blender_checker.png"), "PNG"
picture.save()


def material(name, color, metallic, roughness, image=None):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    shader.inputs["Metallic"].default_value = metallic
    shader.inputs["Roughness"].default_value = roughness
    if image:
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        made.node_tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    return made


def named(name, made=None):
    thing = bpy.context.object
    thing.name = name
    if made:
        thing.data.name = name
        thing.data.materials.append(made)
    return thing


bpy.ops.mesh.primitive_cube_add(size=2, location=(-3, 0.5, 1), rotation=(0.1, 0.2, 0.3))
box = named("box", material("checkered", (1, 1, 1), 0, 0.5, picture))

bpy.ops.object.empty_add(location=(1, 2, 0.5), rotation=(0.4, -0.3, 0.9))
parent = named("parent")
parent.scale = (1, 1.5, 0.75)
bpy.ops.mesh.primitive_uv_sphere_add(segments=8, ring_count=6, radius=1)
bpy.ops.object.shade_smooth()
ball = named("ball", material("bronze", (0.8, 0.4, 0.1), 0.5, 0.6))
ball.parent = parent

bpy.ops.mesh.primitive_cone_add(vertices=6, radius1=1, depth=2, location=(3, -1, 1))
cone = named("cone", material("plain", (0.2, 0.6, 0.3), 0, 0.5))
cone.scale = (-1, 1, 1.25)

bpy.ops.object.light_add(type="SUN", rotation=(0.6, 0.1, 0.8))
named("sun").data.energy = 3
bpy.ops.object.light_add(type="SPOT", location=(4, -4, 5), rotation=(0.7, 0, 0.8))
spot = named("spot").data
spot.spot_size, spot.spot_blend, spot.color = math.radians(50), 0.25, (1, 0.5, 0.25)
bpy.ops.object.camera_add(location=(7, -7, 5), rotation=(1.1, 0, 0.785))
bpy.context.scene.camera = named("eye")

for thing in (box, ball, cone):  # so that both formats have the same triangles
    shape = bmesh.new()
    shape.from_mesh(thing.data)
    bmesh.ops.triangulate(shape, faces=shape.faces)
    shape.to_mesh(thing.data)
    shape.free()

bpy.ops.export_scene.gltf(filepath=str(folder / "blender.glb"), export_format="GLB",
                          export_cameras=True, export_lights=True)
bpy.ops.wm.obj_export(filepath=str(folder / "blender.obj"), path_mode="STRIP")
