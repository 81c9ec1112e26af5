"""The losses, the paper's and those that work better, on the same physics as the loop: Model.forces and
Model.step with tensors.

acceleration   |S^-1 (M nu_dot - F(nu)) - f|^2, one sample at a time
paper          lambda_data |nu(t+h) - nu_pred(t+h)|^2 + lambda_phys |S^-1 R|^2,
    R = M nu_dot_pred - F(nu) - S f,
               nu_dot_pred = d nu_pred/dh by automatic differentiation through Model.step
rollout        Huber of heading, place and speeds along a free run of many steps
orthogonal     what of f lies in the span of the core's own forces: |P f|^2
mirror         f must be mirrored when the ship is (for hulls that are symmetric)
"""

from dataclasses import replace

import torch

from export.residual_network import ResidualNetwork
from twin.physics import core
from twin.physics.model import CORE, Eta_nu, Model
from twin.physics.state import LIGHT, Force, Growth, Situation

ODD = ("sway", "yaw", "rudder", "air_starboard", "wave_starboard", "roll")
Inputs = dict[str, torch.Tensor]  # fields of Situation, each (..., B)


class HeldOutLoss:
    """A learned force that is the same in the whole of a step."""

    force = Force()

    def __call__(self, s: Situation) -> Force:
        return self.force


def needed(model: Model, rate: torch.Tensor, grown: Growth = LIGHT) -> torch.Tensor:
    """(B, 3) M nu_dot in newtons, where the added mass has `grown`."""
    u_dot, v_dot, r_dot = rate.unbind(-1)
    return torch.stack(core.force_for(u_dot, v_dot, r_dot, model.c, grown), -1)


def known(model: Model, s: Situation) -> torch.Tensor:
    """(B, 3) the sum of all known forces; sets the speeds through water of s."""
    forces = model.forces(s, model.water(s))
    return torch.stack([sum((f[i] for f in forces), torch.zeros_like(s.u)) for i in range(3)], -1)


def left_over(model: Model, s: Situation, rate: torch.Tensor, scale: torch.Tensor) -> torch.Tensor:
    """(B, 3) what the known forces leave, in units of the force scale; sets the speeds through water of s."""
    forces = known(model, s)  # first: it finds how its added mass has grown
    return (needed(model, rate, s.grown) - forces) / scale


def acceleration(
    network: ResidualNetwork, zeta: torch.Tensor, d: torch.Tensor, size: torch.Tensor
) -> torch.Tensor:
    """(B,) of each moment."""
    return (((network.f(zeta) - d) / size) ** 2).mean(-1)


def paper(
    network: ResidualNetwork,
    model: Model,
    s: Situation,
    ahead: torch.Tensor,
    h: torch.Tensor,
    size: torch.Tensor,
    lambda_data: float = 1.0,
    lambda_phys: float = 0.1,
) -> tuple[torch.Tensor, dict[str, float]]:
    """The literal loss of one step; `ahead` (B, 3) the measured speeds h later, `size` (3,) of one step's
    change. Diagnostics too."""
    h = h.clone().requires_grad_(True)
    hybrid = replace(model, residual=network)
    start = (s.x, s.y, s.psi, s.u, s.v, s.r)
    nu = torch.stack(hybrid.step(start, s, h)[3:], -1)
    data = (((nu - ahead) / size) ** 2).mean()
    dot = torch.stack([torch.autograd.grad(nu[:, i].sum(), h, create_graph=True)[0] for i in range(3)], -1)
    end = replace(s, u=nu[:, 0], v=nu[:, 1], r=nu[:, 2])
    scale = nu.new_tensor(network.S)
    without = left_over(model, end, dot, scale)
    R = without - network.f(network.zeta(end))
    loss = lambda_data * data + lambda_phys * (R**2).mean()
    return loss, {"data": float(data.detach()), "R": _rms(R), "f": _rms(without)}


def _rms(x: torch.Tensor) -> float:
    return float((x.detach() ** 2).mean().sqrt())


def free_run(
    network: ResidualNetwork | None, model: Model, start: torch.Tensor, inputs: Inputs, h: torch.Tensor
) -> torch.Tensor:
    """(T, B, 6) states after each step; `start` (B, 6), inputs (T + 1, B). The learned force of a step is
    that of its middle, by a line through this step's and the last one's beginnings (Adams-Bashforth): as good
    as asking the network twice."""
    held = HeldOutLoss()
    moving = replace(model, residual=held) if network is not None else model
    x, y, psi, u, v, r = start.unbind(-1)
    state: Eta_nu = x, y, psi, u, v, r
    kept, last = [], None
    for k in range(next(iter(inputs.values())).shape[0] - 1):
        now = {name: x[k] for name, x in inputs.items()}
        if network is not None:
            s = Situation(*state, **now)
            model.forces(s, model.water(s))
            force = network(s)
            held.force, last = (
                Force(*[1.5 * a - 0.5 * b for a, b in zip(force, last or force, strict=True)]),
                force,
            )
        middle = {name: 0.5 * (x[k] + x[k + 1]) for name, x in inputs.items()}
        state = _onward(moving, state, Situation(**middle), h)
        kept.append(torch.stack(state, -1))
    return torch.stack(kept)


def _onward(model: Model, state: Eta_nu, s: Situation, h: torch.Tensor) -> Eta_nu:
    """One step by the midpoint rule: half the work of Model.step, and at STRIDE steps as near to the truth as
    the model is."""
    half = _along(state, model.derivative(state, s), 0.5 * h)
    return _along(state, model.derivative(half, s), h)


def _along(state: Eta_nu, slope: Eta_nu, h: torch.Tensor) -> Eta_nu:
    x, y, psi, u, v, r = [a + h * k for a, k in zip(state, slope, strict=True)]
    return x, y, psi, u, v, r


def allowed(model: Model) -> torch.Tensor:
    """(6,) an error of this size counts as one: a hundredth of its length, its speed, a radian and their
    ratios."""
    L, U = float(model.ship.L_pp), float(model.ship.U_0)
    return 0.01 * torch.tensor([L, L, 1.0, U, U, U / L])


def rollout(
    network: ResidualNetwork,
    model: Model,
    start: torch.Tensor,
    inputs: Inputs,
    wanted: torch.Tensor,
    h: torch.Tensor,
) -> torch.Tensor:
    """(B,) Huber loss along each run; a ship that runs away counts as much as can be."""
    off = (free_run(network, model, start, inputs, h) - wanted) / allowed(model).to(wanted.device)
    off = torch.nan_to_num(off, nan=1e3, posinf=1e3, neginf=-1e3).clamp(-1e3, 1e3)
    return torch.nn.functional.huber_loss(off, torch.zeros_like(off), delta=2.0, reduction="none").mean(
        (0, 2)
    )


def orthogonal(f: torch.Tensor, columns: torch.Tensor) -> torch.Tensor:
    """|P f|^2/|size|^2 of a batch: f (B, 3), columns (B, 3, K) of the core; the basis is not
    differentiated."""
    total = f.new_zeros(())
    for axis in range(3):
        A = columns[:, axis].detach()
        A = A[:, A.abs().amax(0) > 0]
        basis = torch.linalg.qr(A / A.norm(dim=0))[0]
        total = total + ((basis.T @ f[:, axis]) ** 2).sum() / f.shape[0]
    return total


def span(model: Model, s: Situation) -> torch.Tensor:
    """(B, 3, 4) the core's forces one by one: hull, Coriolis, propeller, rudder."""
    forces = model.forces(s, model.water(s))[: len(CORE)]
    return torch.stack(
        [torch.stack([f + torch.zeros_like(s.u) for f in map(torch.as_tensor, tau)], -1) for tau in forces],
        -1,
    )


def mirror(network: ResidualNetwork, zeta: torch.Tensor) -> torch.Tensor:
    """How far f is from that of the mirrored ship, mirrored."""
    sign = zeta.new_tensor([-1.0 if name in ODD else 1.0 for name in network.names])
    return ((network.f(zeta) - network.f(zeta * sign) * zeta.new_tensor([1.0, -1.0, -1.0])) ** 2).mean()
