#version 330 core
// One quad a grain, just large enough for its footprint; everything in pixels from the lower left.
// SPDX-License-Identifier: GPL-3.0-or-later
layout(location = 0) in vec3 grain;     // x, y, radius
layout(location = 1) in vec4 color;

uniform vec4 area;                      // x0, y0 of the target's corner; 2 / width, 2 / height

flat out vec3 disc;
flat out vec3 disc_color;

void main()
{
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    float reach = grain.z + 1.0;
    gl_Position = vec4((grain.xy + corner * reach - area.xy) * area.zw - 1.0, 0.0, 1.0);
    disc = grain - vec3(area.xy, 0.0);
    disc_color = color.rgb;
}
