#version 330 core
// What a grain adds to a pixel: colour times coverage, and coverage.  The same formulas and
// numbers as in src/draw/splat.c, which explains them.
// SPDX-License-Identifier: GPL-3.0-or-later
flat in vec3 disc;
flat in vec3 disc_color;

uniform vec2 style;                     // strength of rims, of shading

out vec4 sum;

float square_coverage(vec2 from_center, float radius)
{
    float half_side = 0.8862269 * radius;
    vec2 low = max(from_center - 0.5, -half_side);
    vec2 high = min(from_center + 0.5, half_side);
    vec2 overlap = max(high - low, 0.0);
    return overlap.x * overlap.y;
}

void main()
{
    vec2 p = gl_FragCoord.xy - disc.xy;
    float r = disc.z;
    if (r < 1.2) {
        float a = square_coverage(p, r);
        sum = vec4(disc_color * a, a);
        return;
    }
    float edge = sqrt(r * r - 1.0 / 12.0);
    float d = length(p);
    float a = clamp(edge + 0.5 - d, 0.0, 1.0);

    vec2 u = p / r - vec2(-0.32, 0.38);
    float q = dot(u, u);
    float shade = style.y * clamp(r - 1.2, 0.0, 1.0);
    float s = max(1.0 - 3.2 * q, 0.0);
    float spot = 0.42 * s * s * shade;
    float light = (1.0 + (1.07 - 0.24 * q - 1.0) * shade) * (1.0 - spot);

    float rim_from = edge - 0.5 - clamp(0.11 * r, 0.8, 2.5);
    float rim = style.x * 0.52 * clamp(r - 1.2, 0.0, 1.0) * clamp(d - rim_from, 0.0, 1.0);
    sum = vec4((disc_color * light + spot) * (1.0 - rim) * a, a);
}
