"""The PID controller written by hand in NumPy, many at once, in the order in which the emitted programs compute.

Made from the description of the controller, not from its intermediate form: no code is shared with what it judges.
"""

import numpy as np

NAMES = ("K", "Ti", "Td", "Tf", "b", "c", "Tt", "h", "u_low", "u_high", "rate")
FLAGS = ("limited_low", "limited_high", "rate_limited", "bad_measurement", "wrong_cycle", "overflow", "refused")


class ReferencePid:
    """One controller for each lane; every quantity is an array with one element a lane, of one type of number."""

    def __init__(self, lanes: int, number: type, compensated: bool = False):
        self.number, self.compensated = number, compensated
        zero = np.zeros(lanes, number)
        for name in (*NAMES, "p1", "p2", "p3", "p4", "p5", "p6", "p24", "du"):
            setattr(self, name, zero.copy())
        for name in ("I", "x", "v", "u", "e", "y_old", "sp_old", "wanted", "lost"):
            setattr(self, name, zero.copy())
        for name in ("ready", "manual", "started", "arriving", *FLAGS):
            setattr(self, name, np.zeros(lanes, bool))

    def put(self, mask: np.ndarray, **values) -> None:
        for name, value in values.items():
            setattr(self, name, np.where(mask, value, getattr(self, name)))

    def switch_on(self, mask: np.ndarray) -> None:
        """As if it had never run, and without settings."""
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                setattr(self, name, np.where(mask, value.dtype.type(0), value))

    def sets(self, settings: np.ndarray) -> None:
        """settings: (11, lanes). Those that differ from the ones in force are taken if they are in range."""
        new = dict(zip(NAMES, settings.astype(self.number), strict=True))
        first = ~self.ready
        asked = first | np.any([new[n] != getattr(self, n) for n in NAMES], axis=0)
        good = (new["K"] - new["K"] == 0) & ((new["K"] > 0) | (new["K"] < 0)) & (new["Ti"] >= 0)
        for name in ("Td", "Tf"):
            good &= (new[name] - new[name] == 0) & (new[name] >= 0)
        for name in ("b", "c"):
            good &= (new[name] >= 0) & (new[name] <= 1)
        good &= (new["h"] - new["h"] == 0) & (new["h"] > 0) & ((new["Tt"] == 0) | (new["Tt"] + new["Tt"] > new["h"]))
        good &= (new["u_low"] < new["u_high"]) & (new["rate"] >= 0)
        taken = asked & good
        K, b, c, p24 = self.K, self.b, self.c, self.p24
        self.put(taken, **new)
        K1, Td, total = self.K, self.Td, self.Tf + self.h
        gain = K1 * Td / total
        self.put(taken, p24=gain, p1=K1 * Td * self.c / total + K1 * self.b, p2=K1 + gain, p3=self.Tf / total)
        self.put(taken, p4=K1 * Td * self.h / (total * total), du=self.rate * self.h)
        self.put(taken, p5=np.where(self.Ti > 0, K1 * self.h / self.Ti, self.number(0)))
        self.put(taken, p6=np.where(self.Tt > 0, self.h / self.Tt, self.number(0)))
        y, sp = self.y_old, self.sp_old
        kept = taken & self.started
        x = self.x + (self.p24 * (y - self.c * sp) + p24 * (c * sp - y))
        integral = self.I + (self.K * (y - self.b * sp) + K * (b * sp - y))
        self.put(kept, x=x, I=integral)
        self._again(kept & self._bad(x, integral))
        self.put(asked, refused=~good)
        self.put(first & good, ready=True)
        self.reset(first & good)

    def _again(self, mask: np.ndarray) -> None:
        self.put(mask, x=self.number(0), I=self.number(0), started=False, arriving=True)

    def reset(self, mask: np.ndarray) -> None:
        zero = self.number(0)
        self.put(mask, I=zero, x=zero, v=zero, u=zero, e=zero, y_old=zero, sp_old=zero, wanted=zero, lost=zero)
        self.put(mask, manual=False, started=False, arriving=False, **dict.fromkeys(FLAGS, False))
        self._limit(mask)

    def _limit(self, mask: np.ndarray) -> None:
        high, low = self.u > self.u_high, self.u < self.u_low
        self.put(mask & high, limited_high=True)
        self.put(mask & low & ~high, limited_low=True)
        self.put(mask, u=np.where(high, self.u_high, np.where(low, self.u_low, self.u)))

    @staticmethod
    def _bad(*values) -> np.ndarray:
        return np.any([~np.isfinite(value) for value in values], axis=0)

    def start(self, y, sp, u0, ff, mask: np.ndarray) -> None:
        bad = self._bad(y, sp, u0, ff)
        self.put(mask, limited_low=False, limited_high=False, rate_limited=False, overflow=False, bad_measurement=bad)
        good = mask & ~bad
        self.put(good, u=u0)
        self._limit(good)
        x = self.p24 * (y - self.c * sp)
        self.put(good, x=x, I=self.u - (ff + self.p1 * sp + x - self.p2 * y), v=self.u, y_old=y, sp_old=sp, e=sp - y)
        self.put(good, manual=False, started=True, arriving=True, lost=self.number(0))
        beyond = good & self._bad(self.x, self.I)
        self._again(beyond)
        self.put(beyond, overflow=True)

    def sets_manual(self, on, u, mask: np.ndarray) -> None:
        self.put(mask & on, manual=True, wanted=np.where(np.isfinite(u), u, self.u))
        self.put(mask & ~on, manual=False)

    def cycle(self, elapsed, mask: np.ndarray) -> None:
        right = (elapsed + elapsed > self.h) & (elapsed + elapsed < self.number(3) * self.h)
        self.put(mask, wrong_cycle=(elapsed != 0) & ~right)

    def step(self, sp, y, ff, mask: np.ndarray) -> None:
        last, manual, arriving, zero = self.u, self.manual, self.arriving, self.number(0)
        bad = self._bad(sp, y, ff)
        x = np.where(self.started, self.x, self.p24 * (y - self.c * sp))
        r = ff + self.p1 * sp + x - self.p2 * y
        v = r + self.I
        x = self.p3 * x + self.p4 * (y - self.c * sp)
        beyond = ~bad & self._bad(v, x)
        held = bad | beyond
        v = np.where(manual, self.wanted, np.where(held | arriving, last, v))
        self.put(mask, limited_low=False, limited_high=False, bad_measurement=bad)
        free = (self.du > 0) & ~manual & ~held
        up, down = free & (v > last + self.du), free & (v < last - self.du)
        self.put(mask, u=np.where(up, last + self.du, np.where(down, last - self.du, v)), rate_limited=up | down)
        self._limit(mask)
        u = self.u
        step = self.p5 * (sp - y) + self.p6 * (u - v)
        outward = ((v > u) & (step > 0)) | ((v < u) & (step < 0))
        step = np.where((self.Tt == 0) & outward, zero, step)
        base = np.where(arriving, v - r, self.I)
        lost = zero
        if self.compensated:
            step = step - np.where(arriving, zero, self.lost)
            lost = np.where(manual, zero, ((base + step) - base) - step)
        integral = np.where(manual, u - r, base + step)
        good = ~held & np.isfinite(integral)
        self.put(mask & good, x=x, I=integral, v=v, y_old=y, sp_old=sp, e=sp - y, started=True, lost=lost)
        self.put(mask, overflow=beyond | (~held & ~np.isfinite(integral)), arriving=manual | (arriving & ~good))

    def seen(self) -> np.ndarray:
        """(6, lanes): u, I, x, v, e and the flags as one number."""
        raised = sum(getattr(self, f).astype(self.number) * self.number(1 << i) for i, f in enumerate(FLAGS))
        return np.array([self.u, self.I, self.x, self.v, self.e, raised])


class ReferenceMachine:
    """The reference behind the interface of a machine: chunks of inputs in, what was seen out."""

    def __init__(self, settings: np.ndarray, number: type, compensated: bool = False):
        self.settings, self.number = settings, number
        self.lanes = np.arange(settings.shape[2])
        self.pid = ReferencePid(settings.shape[2], number, compensated)

    def sample(self, row: dict[str, np.ndarray]) -> np.ndarray:
        """One sample in every lane."""
        pid = self.pid
        y, sp, ff, elapsed, u0 = (row[n].astype(self.number) for n in ("y", "y_sp", "ff", "elapsed", "u_manual"))
        chosen = self.settings[row["index"].astype(int), :, self.lanes].T
        pid.switch_on(row["power"] != 0)
        pid.sets(chosen)
        reset = row["reset"] != 0
        pid.reset(reset & pid.ready)
        run = ~reset & pid.ready
        pid.start(y, sp, u0, ff, run & (row["start"] != 0))
        pid.sets_manual(row["manual"] != 0, u0, run)
        pid.cycle(elapsed, run)
        pid.step(sp, y, ff, run)
        return pid.seen()

    def run(self, chunk: dict[str, np.ndarray]) -> np.ndarray:
        """chunk: arrays (samples, lanes). Returns (samples, 6, lanes)."""
        with np.errstate(all="ignore"):
            return np.array([self.sample({n: a[k] for n, a in chunk.items()}) for k in range(len(chunk["y"]))])
