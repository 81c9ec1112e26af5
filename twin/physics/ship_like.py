"""What the core, the actuators and the effects read of a ship. They need no more of it than this, so that the
ship, which holds actuators and effects, is made of them and not they of it."""

from collections.abc import Sequence
from dataclasses import Field
from typing import Any, ClassVar, Protocol, Self

from .state import Number


class ShipLike(Protocol):
    """A frozen ship in SI; `particulars.py` says what each number means. None: not known of it."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]  # so that `replace` makes a changed one

    @property
    def L_pp(self) -> Number:
        """Length between perpendiculars [m]."""

    @property
    def B(self) -> Number:
        """Beam [m]."""

    @property
    def T(self) -> Number:
        """Draught [m]."""

    @property
    def m(self) -> Number:
        """Mass [kg]."""

    @property
    def C_b(self) -> Number:
        """Block coefficient [-]."""

    @property
    def x_G(self) -> Number:
        """Centre of gravity, ahead of midship [m]."""

    @property
    def I_z(self) -> Number:
        """Moment of inertia in yaw about midship [kg m2]."""

    @property
    def rho(self) -> Number:
        """Density of the water [kg/m3]."""

    @property
    def U_0(self) -> Number:
        """Service speed [m/s]."""

    @property
    def D_P(self) -> Number:
        """Propeller diameter [m]."""

    @property
    def A_R(self) -> Number:
        """Rudder area [m2]."""

    @property
    def A_F(self) -> Number:
        """Frontal area above the water [m2]."""

    @property
    def A_L(self) -> Number:
        """Lateral area above the water [m2]."""

    @property
    def derivatives(self) -> Any:
        """In prime form, by Fossen's names."""

    @property
    def actuators(self) -> Sequence[Any]:
        """What drives and steers it; none: one propeller with a rudder behind it."""

    @property
    def c(self) -> Any:
        """Its derivatives with their units (`core.Coefficients`)."""

    def scale(self, of: str) -> Number:
        """Its own size of 'force' [N], 'moment' [N m], 'speed' [m/s], 'time' [s] or 'length' [m]."""

    def with_derivatives(self, **values: Number) -> Self:
        """The same with some of its derivatives changed."""

    def actuator(self, name: str) -> Any:
        """The actuator of that name; KeyError when it has none."""
