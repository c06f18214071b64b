"""torch: whole-array operations, forces summed with index_add_."""

from __future__ import annotations

import torch

from .problem import Advance, Float32Array, Problem

__all__ = ["all_cores"]


def all_cores(problem: Problem) -> Advance:
    """On torch's own threads."""
    corners = torch.from_numpy(problem.triangles).long().T.contiguous()
    i, j, k = corners
    targets = torch.cat([i, j, k])
    edges = torch.from_numpy(problem.inverse_edges).reshape(-1, 2, 2)
    b00, b01, b10, b11 = (edges.reshape(-1, 4)[:, n].contiguous() for n in range(4))
    shear, bulk = (torch.from_numpy(problem.stiffness)[:, n].contiguous() for n in range(2))
    factor = problem.step * torch.from_numpy(problem.inverse_mass)[:, None]

    @torch.inference_mode()
    def advance(u: Float32Array, v: Float32Array, steps: int) -> None:
        displacement, velocity = torch.from_numpy(u), torch.from_numpy(v)
        for _ in range(steps):
            x0, x1, x2 = displacement[i], displacement[j], displacement[k]
            (ax, ay), (bx, by) = (x1 - x0).T, (x2 - x0).T
            g00, g01, g10, g11 = ax * b00 + bx * b10, ax * b01 + bx * b11, ay * b00 + by * b10, ay * b01 + by * b11
            cosine, sine = 2 + g00 + g11, g10 - g01
            scale = torch.rsqrt(cosine * cosine + sine * sine)
            cosine, sine = cosine * scale, sine * scale
            pressure = bulk * (g00 + g11 + g00 * g11 - g01 * g10)
            e00, e11 = 1 + g00, 1 + g11
            p00, p01 = shear * (e00 - cosine) + pressure * e11, shear * (g01 + sine) - pressure * g10
            p10, p11 = shear * (g10 - sine) - pressure * g01, shear * (e11 - cosine) + pressure * e00
            first = torch.stack([p00 * b00 + p01 * b01, p10 * b00 + p11 * b01], dim=1)
            second = torch.stack([p00 * b10 + p01 * b11, p10 * b10 + p11 * b11], dim=1)
            force = torch.zeros_like(displacement).index_add_(0, targets, torch.cat([first + second, -first, -second]))
            velocity.add_(factor * force).mul_(problem.decay)
            displacement.add_(velocity, alpha=problem.step)

    return advance
