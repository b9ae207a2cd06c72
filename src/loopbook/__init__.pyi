"""The names of `loopbook.TABLE` for editors and type checkers; a test holds the two together."""

from derivations.errors import LoopbookError as LoopbookError
from loopbook import design as design
from loopbook import documents as documents
from loopbook import experiments as experiments
from loopbook import plots as plots
from loopbook import tuning as tuning
from loopbook.controllers.interop import from_control as from_control
from loopbook.controllers.interop import to_control as to_control
from loopbook.controllers.on_off import OnOff as OnOff
from loopbook.controllers.pid import Pid as Pid
from loopbook.controllers.pid_forms import PidParallel as PidParallel
from loopbook.controllers.pid_forms import PidSeries as PidSeries
from loopbook.controllers.pid_forms import PidStandard as PidStandard
from loopbook.controllers.regulator import Regulator as Regulator
from loopbook.controllers.rst import Rst as Rst
from loopbook.controllers.settings import PidSettings as PidSettings
from loopbook.experiments.data import FrequencyData as FrequencyData
from loopbook.experiments.data import IntegratingPulseData as IntegratingPulseData
from loopbook.experiments.data import IntegratingStepData as IntegratingStepData
from loopbook.experiments.data import StepData as StepData
from loopbook.experiments.data import TwoLagData as TwoLagData
from loopbook.identification.arrays import identify as identify
from loopbook.loop.compare import compare as compare
from loopbook.loop.continuous import Loop as Loop
from loopbook.loop.diagrams import bode as bode
from loopbook.loop.diagrams import margins as margins
from loopbook.loop.diagrams import nyquist as nyquist
from loopbook.loop.sampled import SampledLoop as SampledLoop
from loopbook.loop.step_info import step_info as step_info
from loopbook.plots.curves import curves as curves
from loopbook.plots.stairs import stairs as stairs
from loopbook.pole_placement.place import place as place
from loopbook.process.construct import tf as tf
from loopbook.process.from_symbols import process_of as process_of
from loopbook.process.sampled import SampledProcess as SampledProcess
from loopbook.process.sampled import sample as c2d
from loopbook.process.sampled import sample as sample
from loopbook.process.transfer_function import DelayedSum as DelayedSum
from loopbook.process.transfer_function import Process as Process
from loopbook.records.reading import read_record as read_csv
from loopbook.records.record import Record as Record
from loopbook.response.simulation import simulate as simulate
from loopbook.tuning.by_name import tune as tune
from loopbook.tuning.result import Tuning as Tuning
from loopbook.vendors.entered import enter as enter
from loopbook.vendors.entered import vendor_forms as vendor_forms

TABLE: dict[str, str]
__all__ = [
    "DelayedSum",
    "FrequencyData",
    "IntegratingPulseData",
    "IntegratingStepData",
    "Loop",
    "LoopbookError",
    "OnOff",
    "Pid",
    "PidParallel",
    "PidSeries",
    "PidSettings",
    "PidStandard",
    "Process",
    "Record",
    "Regulator",
    "Rst",
    "SampledLoop",
    "SampledProcess",
    "StepData",
    "Tuning",
    "TwoLagData",
    "bode",
    "c2d",
    "compare",
    "curves",
    "design",
    "documents",
    "enter",
    "experiments",
    "from_control",
    "identify",
    "margins",
    "nyquist",
    "place",
    "plots",
    "process_of",
    "read_csv",
    "sample",
    "simulate",
    "stairs",
    "step_info",
    "tf",
    "to_control",
    "tune",
    "tuning",
    "vendor_forms",
]
