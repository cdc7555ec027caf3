#version 330 core
// Each shape is a signed distance in pixels, and a pixel is covered by clamp(1/2 - distance): exact
// for straight edges along the axes, and within a few per cent of the covered area for the others.
// SPDX-License-Identifier: GPL-3.0-or-later
uniform sampler2D glyphs;

in vec4 local;
flat in vec4 shape;
flat in vec4 color;
flat in float kind;

out vec4 pixel_color;

// A box of half extents shape.xy rounded by shape.z: lines, discs and rectangles are its cases.
float box_distance(vec2 p)
{
    vec2 q = abs(p) - shape.xy;
    return length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - shape.z;
}

// The part of a circle of radius shape.x within the angle of cosine and sine shape.zw from +u,
// drawn with half the width shape.y and round ends.
float arc_distance(vec2 p)
{
    vec2 q = vec2(p.x, abs(p.y));
    bool beyond = q.y * shape.z > q.x * shape.w;
    float d = beyond ? length(q - shape.x * shape.zw) : abs(length(q) - shape.x);
    return d - shape.y;
}

// From u = 0 to shape.x: a shaft of half the width shape.y, a head of length and half width
// shape.zw.
float arrow_distance(vec2 p)
{
    float v = abs(p.y), neck = shape.x - shape.z;
    float shaft = max(max(-p.x, p.x - neck - 1.0), v - shape.y);
    float flank = (v * shape.z + (p.x - shape.x) * shape.w) * inversesqrt(dot(shape.zw, shape.zw));
    return min(shaft, max(flank, neck - p.x));
}

void main()
{
    float cover;
    if (kind < 0.5) cover = clamp(0.5 - box_distance(local.xy), 0.0, 1.0);
    else if (kind < 1.5) cover = clamp(0.5 - arc_distance(local.xy), 0.0, 1.0);
    else if (kind < 2.5) cover = clamp(0.5 - arrow_distance(local.xy), 0.0, 1.0);
    else if (kind < 3.5) cover = clamp(0.5 + min(min(local.x, local.y), local.z), 0.0, 1.0);
    else {
        cover = texelFetch(glyphs, ivec2(local.xy), 0).r;
        cover += shape.x * cover * (1.0 - cover);
    }
    pixel_color = vec4(color.rgb, color.a * cover);
}
