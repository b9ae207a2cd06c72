"""The names of `loopbook.TABLE` for editors and type checkers; a test holds the two together."""

from derivations.errors import LoopbookError as LoopbookError
from loopbook import design as design
from loopbook import documents as documents
from loopbook import experiments as experiments
from loopbook import plots as plots
from loopbook import tuning as tuning
from loopbook.controllers.as_pid import as_pid as as_pid
from loopbook.controllers.on_off import OnOff as OnOff
from loopbook.controllers.parallel_settings import ParallelSettings as ParallelSettings
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
from loopbook.loop.cascade import CascadeLoop as CascadeLoop
from loopbook.loop.compare import compare as compare
from loopbook.loop.continuous import Loop as Loop
from loopbook.loop.crossovers import crossovers as crossovers
from loopbook.loop.diagrams import bode as bode
from loopbook.loop.diagrams import margins as margins
from loopbook.loop.diagrams import nyquist as nyquist
from loopbook.loop.discrete import DiscreteLoop as DiscreteLoop
from loopbook.loop.feedback import feedback as feedback
from loopbook.loop.feedforward import FeedforwardLoop as FeedforwardLoop
from loopbook.loop.feedforward import feedforward as feedforward
from loopbook.loop.general import GeneralLoop as GeneralLoop
from loopbook.loop.interop import from_control as from_control
from loopbook.loop.interop import to_control as to_control
from loopbook.loop.roots import dcgain as dcgain
from loopbook.loop.roots import poles as poles
from loopbook.loop.roots import zeros as zeros
from loopbook.loop.sampled import SampledLoop as SampledLoop
from loopbook.loop.smith import SmithLoop as SmithLoop
from loopbook.loop.step_info import step_info as step_info
from loopbook.loop.time_response import impulse_response as impulse_response
from loopbook.loop.time_response import ramp_response as ramp_response
from loopbook.loop.time_response import step_response as step_response
from loopbook.plots.curves import curves as curves
from loopbook.plots.stairs import stairs as stairs
from loopbook.pole_placement.place import place as place
from loopbook.pole_placement.polynomial_equation import diophantine as diophantine
from loopbook.pole_placement.state_feedback import observer as observer
from loopbook.pole_placement.state_feedback import state_feedback as state_feedback
from loopbook.pole_placement.state_feedback import state_regulator as state_regulator
from loopbook.process.construct import tf as tf
from loopbook.process.discrete import DiscreteProcess as DiscreteProcess
from loopbook.process.discretise import c2d as c2d
from loopbook.process.from_symbols import process_of as process_of
from loopbook.process.pade import pade as pade
from loopbook.process.reduction import reduced as reduced
from loopbook.process.sampled import SampledProcess as SampledProcess
from loopbook.process.sampled import sample as sample
from loopbook.process.state_space_in import ss as ss
from loopbook.process.thiran import thiran as thiran
from loopbook.process.transfer_function import DelayedSum as DelayedSum
from loopbook.process.transfer_function import Process as Process
from loopbook.process.transfer_function import TransferFunction as TransferFunction
from loopbook.records.reading import read_record as read_csv
from loopbook.records.record import Record as Record
from loopbook.response.simulation import simulate as simulate
from loopbook.tuner_page.turned import tuner as tuner
from loopbook.tuning.by_name import tune as tune
from loopbook.tuning.result import Tuning as Tuning
from loopbook.vendors.entered import enter as enter
from loopbook.vendors.entered import vendor_forms as vendor_forms

TABLE: dict[str, str]
__all__ = [
    "CascadeLoop",
    "DelayedSum",
    "DiscreteLoop",
    "DiscreteProcess",
    "FeedforwardLoop",
    "FrequencyData",
    "GeneralLoop",
    "IntegratingPulseData",
    "IntegratingStepData",
    "Loop",
    "LoopbookError",
    "OnOff",
    "ParallelSettings",
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
    "SmithLoop",
    "StepData",
    "TransferFunction",
    "Tuning",
    "TwoLagData",
    "as_pid",
    "bode",
    "c2d",
    "compare",
    "crossovers",
    "curves",
    "dcgain",
    "design",
    "diophantine",
    "documents",
    "enter",
    "experiments",
    "feedback",
    "feedforward",
    "from_control",
    "identify",
    "impulse_response",
    "margins",
    "nyquist",
    "observer",
    "pade",
    "place",
    "plots",
    "poles",
    "process_of",
    "ramp_response",
    "read_csv",
    "reduced",
    "sample",
    "simulate",
    "ss",
    "stairs",
    "state_feedback",
    "state_regulator",
    "step_info",
    "step_response",
    "tf",
    "thiran",
    "to_control",
    "tune",
    "tuner",
    "tuning",
    "vendor_forms",
    "zeros",
]
