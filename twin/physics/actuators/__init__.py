"""What drives and steers a ship, part by part: propellers, thrusters, azimuths, waterjets, outboards."""

from .actuator import NUMBERS, OWN, Actuator
from .actuator_channels import CHANNELS_OF, attribute_of
from .kinds import KINDS

__all__ = ["CHANNELS_OF", "KINDS", "NUMBERS", "OWN", "Actuator", "attribute_of"]
