#version 330 core
// Shapes arrive as quads in pixels, y downwards; see src/draw/ink.c for what local and shape hold.
// SPDX-License-Identifier: GPL-3.0-or-later
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 local_in;
layout(location = 2) in vec4 shape_in;
layout(location = 3) in vec4 color_in;
layout(location = 4) in float kind_in;

uniform vec2 pixel;             // 2 / width, 2 / height

out vec4 local;
flat out vec4 shape;
flat out vec4 color;
flat out float kind;

void main()
{
    gl_Position = vec4(position.x * pixel.x - 1.0, 1.0 - position.y * pixel.y, 0.0, 1.0);
    local = local_in;
    shape = shape_in;
    color = color_in;
    kind = kind_in;
}
