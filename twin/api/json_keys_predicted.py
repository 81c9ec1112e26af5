"""What the keys of `twin tube` and `twin.simulate` mean: results of predictions, beside those of the study
(json_keys.py)."""

from twin.api.json_key import ABOUT, CLI, JsonKey, under

MET = "45 voyages met it"
SIZE = (
    JsonKey("voyages", "", "voyages that the promise rests on"),
    JsonKey("predictions", "", "predictions that came due on all of them"),
    JsonKey("place_m", "m", "radius of the circle of the ellipse's area, in the mean"),
    JsonKey("heading_deg", "deg", "half width around the heading, in the mean"),
)
TUBE = (
    *ABOUT,
    JsonKey("level", "-", "what is asked for: share of places, and of headings, inside"),
    JsonKey("voyages[].name", "", "voyages that were taken through the loop: name of the voyage"),
    JsonKey("voyages[].predictions", "", "predictions that came due with helm and engine held, all horizons"),
    JsonKey("horizons[].horizon_s", "s", "how far ahead"),
    JsonKey("horizons[].level", "-", "what is promised: the level, or the best that so few voyages can show"),
    *under("horizons[]", SIZE),
    JsonKey("horizons[].regimes[].regime", "", "helm and sea that have a tube of their own", MET),
    *(k._replace(when=MET) for k in under("horizons[].regimes[]", SIZE)),
    JsonKey("doubts[]", "", "what these voyages cannot promise, and what to do", "there is something"),
    JsonKey("output", "", "the ship file that was written", CLI),
)
SIMULATE = (
    *ABOUT,
    JsonKey("manoeuvre", "", "what was sailed, as it was asked for: straight, zigzag_ANGLE or circle_ANGLE"),
    JsonKey("columns.time_s[]", "s", "times from the beginning"),
    JsonKey("columns.*[]", "of the channel", "position, heading and speeds at these times, by channel"),
)
