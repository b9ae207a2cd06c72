"""Control engineering in numbers, with exact dead time: processes, controllers, loops, experiments, tuning, design.

    import loopbook as lb

    process = lb.tf(2, [40, 14, 1], delay=3)                  # 2 e^(-3s)/((10 s + 1)(4 s + 1)), time in seconds
    loop = lb.Loop(process, lb.tune(process, "amigo", "PID"))
    print(loop.margins(), lb.step_info(loop))
    loop.plot()

This is the public surface: ``TABLE`` decides it, and each name is imported when it is first asked for. Times are in
seconds, frequencies in rad/s, phases that are shown in degrees.

>>> import loopbook as lb
>>> round(lb.Loop(lb.tf(2, [10, 1], 3), lb.PidStandard(0.5, 10)).margins().phase, 2)
72.81
"""

from loopbook.lazy import attach

TABLE = {
    # what is controlled
    "Process": "loopbook.process.transfer_function:Process",
    "DelayedSum": "loopbook.process.transfer_function:DelayedSum",
    "SampledProcess": "loopbook.process.sampled:SampledProcess",
    "TransferFunction": "loopbook.process.transfer_function:TransferFunction",
    "tf": "loopbook.process.construct:tf",
    "process_of": "loopbook.process.from_symbols:process_of",
    "sample": "loopbook.process.sampled:sample",
    "c2d": "loopbook.process.discretise:c2d",
    "DiscreteProcess": "loopbook.process.discrete:DiscreteProcess",
    "ss": "loopbook.process.state_space_in:ss",
    "pade": "loopbook.process.pade:pade",
    "thiran": "loopbook.process.thiran:thiran",
    "reduced": "loopbook.process.reduction:reduced",
    "to_control": "loopbook.loop.interop:to_control",
    "from_control": "loopbook.loop.interop:from_control",
    # what controls it
    "PidStandard": "loopbook.controllers.pid_forms:PidStandard",
    "PidParallel": "loopbook.controllers.pid_forms:PidParallel",
    "PidSeries": "loopbook.controllers.pid_forms:PidSeries",
    "as_pid": "loopbook.controllers.as_pid:as_pid",
    "Regulator": "loopbook.controllers.regulator:Regulator",
    "Rst": "loopbook.controllers.rst:Rst",
    "Pid": "loopbook.controllers.pid:Pid",
    "PidSettings": "loopbook.controllers.settings:PidSettings",
    "ParallelSettings": "loopbook.controllers.parallel_settings:ParallelSettings",
    "OnOff": "loopbook.controllers.on_off:OnOff",
    # the loop
    "Loop": "loopbook.loop.continuous:Loop",
    "GeneralLoop": "loopbook.loop.general:GeneralLoop",
    "SmithLoop": "loopbook.loop.smith:SmithLoop",
    "CascadeLoop": "loopbook.loop.cascade:CascadeLoop",
    "FeedforwardLoop": "loopbook.loop.feedforward:FeedforwardLoop",
    "feedforward": "loopbook.loop.feedforward:feedforward",
    "DiscreteLoop": "loopbook.loop.discrete:DiscreteLoop",
    "SampledLoop": "loopbook.loop.sampled:SampledLoop",
    "feedback": "loopbook.loop.feedback:feedback",
    "poles": "loopbook.loop.roots:poles",
    "zeros": "loopbook.loop.roots:zeros",
    "dcgain": "loopbook.loop.roots:dcgain",
    "step_response": "loopbook.loop.time_response:step_response",
    "impulse_response": "loopbook.loop.time_response:impulse_response",
    "ramp_response": "loopbook.loop.time_response:ramp_response",
    "margins": "loopbook.loop.diagrams:margins",
    "crossovers": "loopbook.loop.crossovers:crossovers",
    "bode": "loopbook.loop.diagrams:bode",
    "nyquist": "loopbook.loop.diagrams:nyquist",
    "compare": "loopbook.loop.compare:compare",
    "simulate": "loopbook.response.simulation:simulate",
    "step_info": "loopbook.loop.step_info:step_info",
    # how its controller is found
    "tune": "loopbook.tuning.by_name:tune",
    "Tuning": "loopbook.tuning.result:Tuning",
    "place": "loopbook.pole_placement.place:place",
    # how it is typed into a controller
    "enter": "loopbook.vendors.entered:enter",
    "vendor_forms": "loopbook.vendors.entered:vendor_forms",
    "diophantine": "loopbook.pole_placement.polynomial_equation:diophantine",
    "state_feedback": "loopbook.pole_placement.state_feedback:state_feedback",
    "observer": "loopbook.pole_placement.state_feedback:observer",
    "state_regulator": "loopbook.pole_placement.state_feedback:state_regulator",
    "tuner": "loopbook.tuner_page.turned:tuner",
    # what is known of the process
    "StepData": "loopbook.experiments.data:StepData",
    "IntegratingStepData": "loopbook.experiments.data:IntegratingStepData",
    "FrequencyData": "loopbook.experiments.data:FrequencyData",
    "TwoLagData": "loopbook.experiments.data:TwoLagData",
    "IntegratingPulseData": "loopbook.experiments.data:IntegratingPulseData",
    "Record": "loopbook.records.record:Record",
    "read_csv": "loopbook.records.reading:read_record",
    "identify": "loopbook.identification.arrays:identify",
    # what an answer in words is
    "LoopbookError": "derivations.errors:LoopbookError",
    # what a chapter draws
    "curves": "loopbook.plots.curves:curves",
    "stairs": "loopbook.plots.stairs:stairs",
    # by subject
    "tuning": "loopbook.tuning",
    "experiments": "loopbook.experiments",
    "plots": "loopbook.plots",
    "design": "loopbook.design",
    "documents": "loopbook.documents",
}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
