"""Makes still_life.glb, and still_life.png as Blender itself draws it, by Blender 3.4:

    blender -b --factory-startup --python still_life.py -- FOLDER

All is matte, in hard light: what Blender and lesson 12 agree on. Blender's tracer follows a ray to
the sun for each of 256 samples a pixel; it has no shadow map, no depth buffer and no mip levels.
"""
import math
import sys
from pathlib import Path

import bpy

AMBIENT = (0.04, 0.05, 0.07, 1)  # the lessons' light from all sides
folder = Path(sys.argv[-1]).resolve()
bpy.ops.wm.read_factory_settings(use_empty=True)

stripes = bpy.data.images.new("still_life_stripes", 64, 64)
stripes.pixels = [
    c for i in range(4096)
    for c in ((0.9, 0.75, 0.45, 1) if (i % 64 // 16 + i // 1024) % 2 else (0.2, 0.45, 0.6, 1))]
stripes.pack()


def material(name, color, image=None):
    """For the file: rough and no metal. Blender's own picture gets paint() later."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1)
    shader.inputs["Roughness"].default_value = 1
    if image:
        texture = made.node_tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        made.node_tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    made.use_backface_culling = True
    return made


def paint(made):
    """Light by the cosine, and a little from all sides."""
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"].inputs["Base Color"]
    matte, product, glow, both = (
        nodes.new(f"ShaderNode{kind}") for kind in ("BsdfDiffuse", "MixRGB", "Emission", "AddShader"))
    product.blend_type = "MULTIPLY"
    product.inputs["Fac"].default_value, product.inputs["Color2"].default_value = 1, AMBIENT
    for color in (matte.inputs["Color"], product.inputs["Color1"]):
        color.default_value = shader.default_value
        if shader.is_linked:
            links.new(shader.links[0].from_socket, color)
    links.new(product.outputs[0], glow.inputs["Color"])
    seen = nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"]
    links.new(seen, glow.inputs["Strength"])  # it lights nothing else
    links.new(matte.outputs[0], both.inputs[0])
    links.new(glow.outputs[0], both.inputs[1])
    links.new(both.outputs[0], nodes["Material Output"].inputs["Surface"])


def add(name, made, smooth=False):
    thing = bpy.context.object
    thing.name = thing.data.name = name
    thing.data.materials.append(made)
    if smooth:
        bpy.ops.object.shade_smooth()
    return thing


bpy.ops.mesh.primitive_plane_add(size=9)
add("table", material("table", (0.55, 0.5, 0.42)))
bpy.ops.mesh.primitive_cube_add(size=1.7, location=(-1.4, 0.9, 0.85), rotation=(0, 0, 0.5))
add("box", material("striped", (1, 1, 1), stripes))
bpy.ops.object.empty_add(location=(1.1, 0.3, 0.9), rotation=(0, 0.5, 0.4))
parent = bpy.context.object
parent.name, parent.scale = "parent", (1.1, 0.8, 0.8)
bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=1)
add("ball", material("red", (0.75, 0.12, 0.08)), smooth=True).parent = parent
bpy.ops.mesh.primitive_torus_add(location=(-0.3, -1.7, 0.26), major_radius=0.62, minor_radius=0.26,
                                 major_segments=64, minor_segments=24)
add("ring", material("green", (0.12, 0.45, 0.25)), smooth=True)
bpy.ops.mesh.primitive_cone_add(vertices=5, radius1=0.55, depth=1.7, location=(2.3, -1.5, 0.85))
add("cone", material("yellow", (0.8, 0.55, 0.1))).scale = (-1, 1, 1)

bpy.ops.object.light_add(type="SUN", rotation=(0.2, 0.75, 0.35))
sun = bpy.context.object
sun.name, sun.data.energy, sun.data.angle = "sun", math.pi, 0  # white is white
bpy.ops.object.camera_add(location=(4.2, -9.6, 6.1), rotation=(1.07, 0, 0.4))
camera = bpy.context.object
camera.name, camera.data.angle = "front", 0.66

bpy.ops.export_scene.gltf(filepath=str(folder / "still_life.glb"), export_format="GLB",
                          export_cameras=True, export_lights=True)

for made in bpy.data.materials:
    paint(made)
scene = bpy.context.scene
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = 256, False, False
scene.cycles.max_bounces = 0
scene.cycles.pixel_filter_type = "BOX"  # the mean of a pixel, and nothing of its neighbours
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 320, 180, 100
scene.render.film_transparent = True
scene.view_settings.view_transform = "Standard"
scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGBA"
scene.render.filepath = str(folder / "still_life.png")
bpy.ops.render.render(write_still=True)
