# SPDX-License-Identifier: MIT
"""Charts by matplotlib, which is imported when the first one is drawn."""
import math


def pyplot():
    """matplotlib.pyplot, or one line where it is not installed."""
    try:
        from matplotlib import pyplot as module
    except ImportError:
        raise ImportError("plot() needs matplotlib: python3-matplotlib of Debian, or pip install matplotlib") from None
    return module


def bars(axes, values, label):
    """A bar a name."""
    axes = pyplot().subplots(layout="constrained")[1] if axes is None else axes
    axes.bar(range(len(values)), list(values.values()), color="C0", alpha=0.7)
    axes.set_xticks(range(len(values)), list(values), rotation=20 if len(values) > 4 else 0)
    axes.set_ylabel(label)
    return axes


def intervals(axes, numbers):
    """Intervals over their values, a line a number; those without an end, or about 0, are left out."""
    shown = {name: one for name, one in numbers.items()
             if one.low is not None and one.high is not None and one.value and one.excitation in ("good", "fair")
             and abs(one.high - one.low) < 2 * abs(one.value)}
    axes = pyplot().subplots(layout="constrained")[1] if axes is None else axes
    for place, one in enumerate(shown.values()):
        low, high = sorted((one.low / one.value, one.high / one.value))
        axes.plot([low, high], [place, place], "C0-", linewidth=3, solid_capstyle="butt")
        axes.plot(1.0, place, "k|")
    axes.set_yticks(range(len(shown)), [f"{name} = {one.value:.3g} {one.unit}" for name, one in shown.items()])
    axes.set_xlabel("95 % interval / value")
    return axes


def errors(axes, traces):
    """Distances from a path over time."""
    axes = pyplot().subplots(layout="constrained")[1] if axes is None else axes
    for name, trace in traces.items():
        axes.plot(trace["time_s"], trace["error_m"], label=name.replace("_", " "), linewidth=0.9)
    axes.set(xlabel="time, s", ylabel="position error, m")
    axes.legend(loc="upper right", fontsize="small")
    return axes


def flight(axes, flown):
    """Four charts over time."""
    if axes is None:
        axes = pyplot().subplots(4, sharex=True, layout="constrained", figsize=(8, 8))[1]
    degrees = 180 / math.pi
    for one, values, label, names in (
            (axes[0], flown.velocity_m_s, "velocity, m/s", ("forward", "right", "down")),
            (axes[1], flown.euler_rad * degrees, "attitude, deg", ("roll", "pitch", "yaw")),
            (axes[2], flown.body_rates_rad_s * degrees, "body rates, deg/s", ("roll", "pitch", "yaw")),
            (axes[3], flown.commands, "commands", ("front right", "rear left", "front left", "rear right"))):
        for values_of_one, name in zip(values.T, names):
            one.plot(flown.time_s, values_of_one, label=name, linewidth=0.9)
        one.set_ylabel(label)
        one.legend(loc="upper right", ncol=len(names), fontsize="small")
    axes[3].set_xlabel("time, s")
    return axes
