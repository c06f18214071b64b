"""Warp on the CPU: all steps in one launch of a single thread, which there beats a launch for each phase."""

# Warp reads the annotations as objects; "from __future__ import annotations" would turn them into strings.

import warp as wp

from .problem import Advance, Float32Array, Problem

__all__ = ["one_core"]

wp.config.quiet = True
wp.config.verify_fp = False


@wp.kernel(enable_backward=False)
def _steps(
    steps: int,
    triangles: wp.array(dtype=wp.vec3i),
    edges: wp.array(dtype=wp.vec4),
    stiffness: wp.array(dtype=wp.vec2),
    inverse_mass: wp.array(dtype=float),
    dt: float,
    decay: float,
    u: wp.array(dtype=wp.vec2),
    v: wp.array(dtype=wp.vec2),
    force: wp.array(dtype=wp.vec2),
):
    for _step in range(steps):
        for t in range(triangles.shape[0]):
            corners = triangles[t]
            i = corners[0]
            j = corners[1]
            k = corners[2]
            b = edges[t]
            a1 = u[j] - u[i]
            a2 = u[k] - u[i]
            g00 = a1[0] * b[0] + a2[0] * b[2]
            g01 = a1[0] * b[1] + a2[0] * b[3]
            g10 = a1[1] * b[0] + a2[1] * b[2]
            g11 = a1[1] * b[1] + a2[1] * b[3]
            cosine = 2.0 + g00 + g11
            sine = g10 - g01
            scale = 1.0 / wp.sqrt(cosine * cosine + sine * sine)
            cosine = cosine * scale
            sine = sine * scale
            shear = stiffness[t][0]
            pressure = stiffness[t][1] * (g00 + g11 + g00 * g11 - g01 * g10)
            p00 = shear * (1.0 + g00 - cosine) + pressure * (1.0 + g11)
            p01 = shear * (g01 + sine) - pressure * g10
            p10 = shear * (g10 - sine) - pressure * g01
            p11 = shear * (1.0 + g11 - cosine) + pressure * (1.0 + g00)
            f1 = wp.vec2(p00 * b[0] + p01 * b[1], p10 * b[0] + p11 * b[1])
            f2 = wp.vec2(p00 * b[2] + p01 * b[3], p10 * b[2] + p11 * b[3])
            force[j] = force[j] - f1
            force[k] = force[k] - f2
            force[i] = force[i] + f1 + f2
        for i in range(u.shape[0]):
            v[i] = decay * (v[i] + dt * inverse_mass[i] * force[i])
            u[i] = u[i] + dt * v[i]
            force[i] = wp.vec2(0.0, 0.0)


def one_core(problem: Problem) -> Advance:
    """Warp runs CPU kernels on one core."""
    kinds = (wp.vec3i, wp.vec4, wp.vec2, float)
    given = (problem.triangles, problem.inverse_edges, problem.stiffness, problem.inverse_mass)
    constants = [wp.array(values, dtype=kind, device="cpu") for values, kind in zip(given, kinds, strict=True)]
    force = wp.zeros(len(problem.inverse_mass), dtype=wp.vec2, device="cpu")

    def advance(u: Float32Array, v: Float32Array, steps: int) -> None:
        state = [wp.array(values, dtype=wp.vec2, device="cpu", copy=False) for values in (u, v)]
        inputs = [steps, *constants, problem.step, problem.decay, *state, force]
        wp.launch(_steps, dim=1, inputs=inputs, device="cpu")

    return advance
