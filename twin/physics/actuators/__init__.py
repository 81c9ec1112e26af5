"""What drives and steers a ship, part by part: propellers, thrusters, azimuths, waterjets, outboards."""

from .actuator import NUMBERS, OWN, Actuator
from .actuator_channels import CHANNELS_OF, attribute_of
from .kept_forces import KeptForces
from .kinds import KINDS

__all__ = ["CHANNELS_OF", "KINDS", "NUMBERS", "OWN", "Actuator", "KeptForces", "attribute_of"]
