"""What every key of `twin fleet --json` means."""

from twin.api.json_key import CLI, JsonKey, under

JUDGED = "it was judged"
NAMED = "a cause is named"
WEIGHED = "a cause is likely"
DATED = (
    JsonKey("voyage", "", "its name"),
    JsonKey("file", "", "its file"),
    JsonKey("start_time_utc", "", "when it began, or null where its file does not say"),
)
SIZE = (
    JsonKey("name", "", "a number of the cause"),
    JsonKey("value", "of the number", "its estimate"),
    JsonKey("low95", "of the number", "lower end of its 95 % interval"),
    JsonKey("high95", "of the number", "upper end"),
    JsonKey("unit", "", "its unit"),
    JsonKey("at_box_end", "", "whether the end of its box stopped the number"),
    JsonKey("in_ship_file", "of the number", "what the ship file has, or null"),
)
CAUSE = (
    JsonKey("effect", "", "name of the effect"),
    JsonKey("lasting", "", "whether it holds on another day, for `twin add`"),
    JsonKey("belongs_to", "", "ship, instrument or voyage"),
    JsonKey("probability", "1", "that it is there, among all that was weighed"),
    JsonKey("confidence", "1", "share of causes with such facts that were there on other ships, or null"),
    JsonKey("says", "", "what the effect is, in a sentence"),
    JsonKey("share_of_error", "-", "1 - open-loop error with it / without it, on parts not fitted, or null"),
    JsonKey("typical_force.X_N", "N", "root mean square of its force ahead"),
    JsonKey("typical_force.Y_N", "N", "root mean square of its side force"),
    JsonKey("typical_force.N_Nm", "N m", "root mean square of its yaw moment"),
    JsonKey("cannot_be_told_from[]", "", "effects that would explain nearly as much"),
)


def when(condition: str, keys: tuple[JsonKey, ...]) -> tuple[JsonKey, ...]:
    """The keys of what is not always there."""
    return tuple(k._replace(when=k.when or condition) for k in keys)


FLEET = (
    JsonKey("schema_version", "", "version of this format"),
    JsonKey("ships[].rank", "", "place, 1: most wrong"),
    JsonKey("ships[].ship", "", "its name"),
    JsonKey("ships[].file", "", "its ship file"),
    JsonKey("ships[].state", "", "missing, weather (water and weather alone are named), unknown, undecided, "
            "nothing_missing, not_asked (no voyage could be judged)"),
    JsonKey("ships[].verdict", "", "that of its latest voyage, or null"),
    JsonKey("ships[].reason", "", "the rule that decided (docs/diagnosis.md), or null"),
    JsonKey("ships[].sentence", "", "the sentence that goes with it, or null"),
    JsonKey("ships[].latest", "", "null: no voyage could be judged", "none could"),
    *when("one was judged", under("ships[].latest", DATED, "latest voyage that was judged: ")),
    JsonKey("ships[].since", "", "null: no voyage could be judged", "none could"),
    *when("one was judged", under("ships[].since", DATED, "voyage since which its verdict is the same: ")),
    *when(NAMED, under("ships[].causes[]", CAUSE)),
    JsonKey("ships[].causes[].number", "", "null: the effect has no number", "it has none"),
    *when(NAMED, under("ships[].causes[].number", SIZE, "clearest number: ")),
    *when(NAMED, under("ships[].causes[].since", DATED, "first that names it since one was healthy: ")),
    JsonKey("ships[].causes[].named_on", "", "voyages on which it is named", NAMED),
    JsonKey("ships[].causes[].of_voyages", "", "voyages that were judged", NAMED),
    *when(NAMED, under("ships[].causes[].sizes[]", DATED, "a voyage that weighed it: ")),
    JsonKey("ships[].causes[].sizes[].named", "", "whether it is named there", NAMED),
    *when(NAMED, under("ships[].causes[].sizes[]", SIZE)),
    JsonKey("ships[].causes[].trend", "", "null: fewer than three sizes", "fewer than three"),
    JsonKey("ships[].causes[].trend.slope", "of the number", "how its size changes", "three sizes"),
    JsonKey("ships[].causes[].trend.low95", "of the number", "lower end of its 95 % interval", "three sizes"),
    JsonKey("ships[].causes[].trend.high95", "of the number", "upper end", "three sizes"),
    JsonKey("ships[].causes[].trend.per", "", "in a month, or from voyage to voyage", "three sizes"),
    JsonKey("ships[].causes[].trend.voyages", "", "sizes that it rests on", "three sizes"),
    JsonKey("ships[].over_months.references", "", "reference voyages whose score the ship file has"),
    JsonKey("ships[].over_months.voyages", "", "voyages with a score"),
    JsonKey("ships[].over_months.value", "-", "test martingale M after the latest voyage (docs/fleet.md)"),
    JsonKey("ships[].over_months.highest", "-", "greatest M so far; at most 1/a with chance a in health"),
    JsonKey("ships[].over_months.at_most", "-", "the greatest M of so many references and voyages"),
    JsonKey("ships[].over_months.typical_now", "-", "M of a lasting fault by so many voyages, typically"),
    JsonKey("ships[].over_months.typical_ever", "-", "the same however many voyages follow"),
    JsonKey("ships[].over_months.alarm", "", "whether its M is an alarm in this fleet"),
    JsonKey("ships[].voyages[].tags.*", "", "what its owner noted", "something was"),
    *under("ships[].voyages[]", DATED, "in the order of sailing: "),
    JsonKey("ships[].voyages[].failed", "", "why it could not be asked, or null"),
    JsonKey("ships[].voyages[].verdict", "", "as of `twin diagnose`; reference: the ship was calibrated on "
            "it; null: it could not be asked"),
    JsonKey("ships[].voyages[].reason", "", "the rule that decided, or null"),
    JsonKey("ships[].voyages[].sentence", "", "the sentence that goes with it, or null"),
    JsonKey("ships[].voyages[].duration_s", "s", "how long it is, or null"),
    JsonKey("ships[].voyages[].p_value", "-", "how often a healthy voyage scores as high, or null"),
    JsonKey("ships[].voyages[].p_value_at_best", "-", "the least that so few references show, or null"),
    JsonKey("ships[].voyages[].references", "", "references that it rests on, or null"),
    JsonKey("ships[].voyages[].score", "-", "the voyage's score, or null"),
    JsonKey("ships[].voyages[].horizon_s", "s", "how far ahead the errors are, or null"),
    JsonKey("ships[].voyages[].position_mae_m", "m", "open-loop error in place (`twin compare`), or null"),
    JsonKey("ships[].voyages[].position_expected_m", "m", "what is expected of the ship, or null"),
    JsonKey("ships[].voyages[].data_checks[]", "", "data checks that ask for a look", "there are some"),
    *when(WEIGHED, under("ships[].voyages[].causes[]", CAUSE, "likely there: ")),
    JsonKey("ships[].voyages[].causes[].named", "", "whether it is named there", WEIGHED),
    *when(WEIGHED, under("ships[].voyages[].causes[].parameters[]", SIZE)),
    JsonKey("counts.missing", "", "ships on which a cause of ship or instruments is named"),
    JsonKey("counts.weather", "", "on which water and weather alone are"),
    JsonKey("counts.unknown", "", "on which something without a name is at work"),
    JsonKey("counts.undecided", "", "whose voyage could not tell"),
    JsonKey("counts.nothing_missing", "", "on which nothing is missing"),
    JsonKey("counts.not_asked", "", "of which no voyage could be judged"),
    JsonKey("voyages.listed", "", "voyages of the list"),
    JsonKey("voyages.judged", "", "voyages that were judged"),
    JsonKey("voyages.references", "", "voyages that their ship was calibrated on"),
    JsonKey("voyages.failed", "", "voyages that could not be asked"),
    JsonKey("over_months.level", "-", "share of the alarms that may be of healthy ships, in the mean"),
    JsonKey("over_months.ships", "", "ships whose M is known"),
    JsonKey("over_months.needed", "-", "M that makes one ship alone an alarm"),
    JsonKey("over_months.alarms[]", "", "ships in an alarm", "there are some"),
    JsonKey("asked_now", "", "voyages that were asked by this run; the others were known"),
    JsonKey("command", "", "the command that made it", CLI),
    JsonKey("rows", "", "the Parquet file with a row a cause and a voyage", CLI),
)  # fmt: skip
