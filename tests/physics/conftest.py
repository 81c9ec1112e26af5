"""A plain ship with round numbers, and a moment at sea in which every field is filled."""

import pytest

from twin.physics.ship import Derivatives, Ship
from twin.physics.state import Situation


@pytest.fixture(scope="session")
def ship() -> Ship:
    return Ship(
        "Round Numbers",
        L_pp=100.0,
        B=20.0,
        T=5.0,
        m=7e6,
        C_b=0.7,
        x_G=-1.0,
        I_z=4.4e9,
        rho=1000.0,
        U_0=5.0,
        D_P=4.0,
        A_R=10.0,
        A_F=200.0,
        A_L=1000.0,
        derivatives=Derivatives(
            X_uu=-0.02,
            K_T0=0.4,
            K_T1=-0.4,
            t=0.2,
            w=0.25,
            epsilon=1.0,
            kappa=0.5,
            C_L=2.5,
            t_R=0.3,
            a_H=0.2,
            x_R=-0.5,
            x_H=-0.4,
            gamma_v=0.4,
            gamma_r=-0.3,
            Y_rdot=0.002,
            N_vdot=0.002,
            N_uv=0.05,
            Y_v=-0.001,
            N_r=-0.0002,
            X_u=-0.0005,
        ),
    )


@pytest.fixture
def moment() -> dict[str, float]:
    """Everything is going on at once, and nothing is zero."""
    return {
        "x": 120.0,
        "y": -40.0,
        "psi": 0.6,
        "u": 4.2,
        "v": -0.5,
        "r": 0.012,
        "u_r": 4.0,
        "v_r": -0.4,
        "delta": 0.2,
        "n": 2.2,
        "t": 700.0,
        "wind_speed": 9.0,
        "wind_to": 2.0,
        "depth": 9.0,
        "H_s": 2.0,
        "T_p": 8.0,
        "wave_to": 1.5,
        "draught": 5.0,
        "bank_port": 60.0,
        "bank_starboard": 25.0,
        "phi": 0.05,
        "u_dot": 0.01,
        "v_dot": -0.02,
        "r_dot": 0.001,
    }


@pytest.fixture
def situation(moment) -> Situation:
    return Situation(**moment)
