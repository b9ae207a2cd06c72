"""Every LaTeX name the converter knows, with the Unicode character and TeX class it stands for.

The tables are strings of ``name character`` pairs so that they can be read and compared by eye.
"""


def _pairs(text: str) -> dict[str, str]:
    words = text.split()
    return dict(zip(words[::2], words[1::2], strict=True))


def _words(text: str) -> list[str]:
    return text.split()


GREEK = _pairs(
    """
    alpha α beta β gamma γ delta δ epsilon ϵ varepsilon ε zeta ζ eta η theta θ vartheta ϑ iota ι kappa κ varkappa ϰ
    lambda λ mu μ nu ν xi ξ omicron ο pi π varpi ϖ rho ρ varrho ϱ sigma σ varsigma ς tau τ upsilon υ phi ϕ varphi φ
    chi χ psi ψ omega ω digamma ϝ
    Gamma Γ Delta Δ Theta Θ Lambda Λ Xi Ξ Pi Π Sigma Σ Upsilon Υ Phi Φ Psi Ψ Omega Ω
    Alpha Α Beta Β Epsilon Ε Zeta Ζ Eta Η Iota Ι Kappa Κ Mu Μ Nu Ν Omicron Ο Rho Ρ Tau Τ Chi Χ
    """
)
ITALIC_GREEK = _pairs(
    "varGamma 𝛤 varDelta 𝛥 varTheta 𝛩 varLambda 𝛬 varXi 𝛯 varPi 𝛱 varSigma 𝛴 varUpsilon 𝛶 varPhi 𝛷 varPsi 𝛹 varOmega 𝛺"
)

ORDINARY = _pairs(
    """
    infty ∞ partial ∂ nabla ∇ emptyset ∅ varnothing ∅ aleph ℵ beth ℶ gimel ℷ daleth ℸ hbar ℏ hslash ℏ ell ℓ wp ℘
    Re ℜ Im ℑ eth ð mho ℧ imath ı jmath ȷ Bbbk 𝕜 Finv Ⅎ Game ⅁ complement ∁ forall ∀ exists ∃ nexists ∄ neg ¬ lnot ¬
    top ⊤ bot ⊥ angle ∠ measuredangle ∡ sphericalangle ∢ triangle △ triangledown ▽ blacktriangle ▲ blacktriangledown ▼
    square □ Box □ blacksquare ■ Diamond ◇ lozenge ◊ blacklozenge ⧫ bigstar ★ clubsuit ♣ diamondsuit ♢ heartsuit ♡
    spadesuit ♠ flat ♭ natural ♮ sharp ♯ surd √ prime ′ backprime ‵ degree ° circledR ® circledS Ⓢ checkmark ✓
    maltese ✠ yen ¥ pounds £ S § P ¶ copyright © backslash \\ diagup ╱ diagdown ╲ AA Å O Ø o ø ae æ AE Æ oe œ OE Œ
    ss ß l ł L Ł infin ∞ empty ∅
    """
)
DOTS = _pairs(
    """
    ldots … dots … dotsc … dotso … mathellipsis … cdots ⋯ dotsb ⋯ dotsm ⋯ dotsi ⋯ vdots ⋮ ddots ⋱ iddots ⋰ adots ⋰
    """
)

LARGE = _pairs(
    """
    sum ∑ prod ∏ coprod ∐ bigcup ⋃ bigcap ⋂ bigvee ⋁ bigwedge ⋀ bigoplus ⨁ bigotimes ⨂ bigodot ⨀ biguplus ⨄ bigsqcup ⨆
    """
)
INTEGRALS = _pairs(
    "int ∫ iint ∬ iiint ∭ iiiint ⨌ oint ∮ oiint ∯ oiiint ∰ varointclockwise ∲ ointctrclockwise ∳ smallint ∫ intop ∫"
)

BINARY = _pairs(
    """
    pm ± mp ∓ times × div ÷ cdot ⋅ ast ∗ star ⋆ circ ∘ bullet ∙ cap ∩ cup ∪ Cap ⋒ Cup ⋓ uplus ⊎ sqcap ⊓ sqcup ⊔
    wedge ∧ land ∧ vee ∨ lor ∨ setminus ∖ smallsetminus ∖ wr ≀ amalg ⨿ oplus ⊕ ominus ⊖ otimes ⊗ oslash ⊘ odot ⊙
    dagger † dag † ddagger ‡ ddag ‡ diamond ⋄ bigcirc ◯ bigtriangleup △ bigtriangledown ▽ triangleleft ◁
    triangleright ▷ lhd ⊲ rhd ⊳ unlhd ⊴ unrhd ⊵ boxplus ⊞ boxminus ⊟ boxtimes ⊠ boxdot ⊡ dotplus ∔ divideontimes ⋇
    ltimes ⋉ rtimes ⋊ leftthreetimes ⋋ rightthreetimes ⋌ circledast ⊛ circledcirc ⊚ circleddash ⊝ centerdot ⋅
    intercal ⊺ veebar ⊻ barwedge ⊼ doublebarwedge ⩞ curlywedge ⋏ curlyvee ⋎ doublecap ⋒ doublecup ⋓
    """
)

RELATIONS = _pairs(
    """
    le ≤ leq ≤ ge ≥ geq ≥ ne ≠ neq ≠ lt < gt > leqslant ⩽ geqslant ⩾ leqq ≦ geqq ≧ lneq ⪇ gneq ⪈ lneqq ≨ gneqq ≩ ll ≪
    gg ≫ lll ⋘ ggg ⋙ nless ≮ ngtr ≯ nleq ≰ ngeq ≱ lesssim ≲ gtrsim ≳ lessgtr ≶ gtrless ≷ lesseqgtr ⋚ gtreqless ⋛
    lessapprox ⪅ gtrapprox ⪆ lessdot ⋖ gtrdot ⋗ prec ≺ succ ≻ preceq ⪯ succeq ⪰ preccurlyeq ≼ succcurlyeq ≽ precsim ≾
    succsim ≿ nprec ⊀ nsucc ⊁ npreceq ⋠ nsucceq ⋡ sim ∼ nsim ≁ simeq ≃ approx ≈ approxeq ≊ cong ≅ ncong ≇ backsim ∽
    backsimeq ⋍ equiv ≡ asymp ≍ doteq ≐ doteqdot ≑ Doteq ≑ fallingdotseq ≒ risingdotseq ≓ eqcirc ≖ circeq ≗ triangleq ≜
    bumpeq ≏ Bumpeq ≎ propto ∝ varpropto ∝ in ∈ notin ∉ ni ∋ owns ∋ subset ⊂ supset ⊃ subseteq ⊆ supseteq ⊇
    subsetneq ⊊ supsetneq ⊋ nsubseteq ⊈ nsupseteq ⊉ subseteqq ⫅ supseteqq ⫆ subsetneqq ⫋ supsetneqq ⫌ Subset ⋐ Supset ⋑
    sqsubset ⊏ sqsupset ⊐ sqsubseteq ⊑ sqsupseteq ⊒ mid ∣ nmid ∤ parallel ∥ nparallel ∦ perp ⟂ vdash ⊢ dashv ⊣
    models ⊨ vDash ⊨ Vdash ⊩ Vvdash ⊪ nvdash ⊬ nvDash ⊭ nVdash ⊮ nVDash ⊯ bowtie ⋈ Join ⋈ smile ⌣ frown ⌢ between ≬
    pitchfork ⋔ therefore ∴ because ∵ vartriangle △ trianglelefteq ⊴ trianglerighteq ⊵ ntriangleleft ⋪ ntriangleright ⋫
    ntrianglelefteq ⋬ ntrianglerighteq ⋭ vartriangleleft ⊲ vartriangleright ⊳ blacktriangleleft ◀ blacktriangleright ▶
    coloneqq ≔ coloneq ≔ eqqcolon ≕ colon : shortmid ∣ shortparallel ∥ eqsim ≂ lesseqqgtr ⪋ gtreqqless ⪌
    """
)
ARROWS = _pairs(
    """
    to → rightarrow → gets ← leftarrow ← uparrow ↑ downarrow ↓ updownarrow ↕ leftrightarrow ↔ Rightarrow ⇒ Leftarrow ⇐
    Uparrow ⇑ Downarrow ⇓ Updownarrow ⇕ Leftrightarrow ⇔ longrightarrow ⟶ longleftarrow ⟵
    longleftrightarrow ⟷ Longrightarrow ⟹ Longleftarrow ⟸ Longleftrightarrow ⟺ mapsto ↦ longmapsto ⟼ hookrightarrow ↪
    hookleftarrow ↩ rightharpoonup ⇀ rightharpoondown ⇁ leftharpoonup ↼ leftharpoondown ↽ rightleftharpoons ⇌
    leftrightharpoons ⇋ nearrow ↗ searrow ↘ swarrow ↙ nwarrow ↖ rightsquigarrow ⇝ leadsto ⇝ leftrightsquigarrow ↭
    nrightarrow ↛ nleftarrow ↚ nleftrightarrow ↮ nRightarrow ⇏ nLeftarrow ⇍ nLeftrightarrow ⇎ rightrightarrows ⇉
    leftleftarrows ⇇ rightleftarrows ⇄ leftrightarrows ⇆ upuparrows ⇈ downdownarrows ⇊ upharpoonright ↾ restriction ↾
    upharpoonleft ↿ downharpoonright ⇂ downharpoonleft ⇃ curvearrowright ↷ curvearrowleft ↶ circlearrowright ↻
    circlearrowleft ↺ dashrightarrow ⇢ dashleftarrow ⇠ twoheadrightarrow ↠ twoheadleftarrow ↞ rightarrowtail ↣
    leftarrowtail ↢ looparrowright ↬ looparrowleft ↫ multimap ⊸ Rrightarrow ⇛ Lleftarrow ⇚ Lsh ↰ Rsh ↱
    """
)

WIDE_RELATIONS = _pairs("implies ⟹ impliedby ⟸ iff ⟺")

OPENING = _pairs(
    """
    lbrace { { { lbrack [ langle ⟨ lfloor ⌊ lceil ⌈ lvert | lVert ‖ lgroup ⟮ lmoustache ⎰ ulcorner ⌜ llcorner ⌞ lang ⟨
    llbracket ⟦
    """
)
CLOSING = _pairs(
    """
    rbrace } } } rbrack ] rangle ⟩ rfloor ⌋ rceil ⌉ rvert | rVert ‖ rgroup ⟯ rmoustache ⎱ urcorner ⌝ lrcorner ⌟ rang ⟩
    rrbracket ⟧
    """
)
BARS = _pairs("vert | Vert ‖ | ‖")

# What may follow \left, \middle, \right and \big: plain characters and named ones.
DELIMITERS = {
    **{c: c for c in "()[]|/⟨⟩⌊⌋⌈⌉‖"},
    **{"<": "⟨", ">": "⟩", ".": ""},
    **{"\\" + name: char for table in (OPENING, CLOSING, BARS) for name, char in table.items()},
    **{"\\" + n: ARROWS[n] for n in ("uparrow", "downarrow", "updownarrow", "Uparrow", "Downarrow", "Updownarrow")},
    "\\backslash": "\\",
}
BIG = {"big": 1.2, "Big": 1.8, "bigg": 2.4, "Bigg": 3.0}

# Characters typed as they are.
CHARACTERS = {
    **{c: (c, "bin") for c in "+±∓×÷⋅∩∪∧∨⊕⊗∘∗"},
    **{c: (c, "rel") for c in "=<>:≤≥≠≈≡≪≫∼≃≅∝∈∉∋⊂⊃⊆⊇→←↔⇒⇐⇔↦⟶⟵⟹⟸⟺≜≔∣∥⟂"},
    **{c: (c, "punct") for c in ",;"},
    **{c: (c, "open") for c in "([⟨⌊⌈"},
    **{c: (c, "close") for c in ")]⟩⌋⌉!?"},
    **{c: (c, "ord") for c in '|/.@"°∞∂∇∅∀∃¬…⋯′″‖%√ℏℓ§'},
    "-": ("−", "bin"),
    "−": ("−", "bin"),
    "–": ("−", "bin"),
    "*": ("∗", "bin"),
    "·": ("⋅", "bin"),
    "`": ("‘", "ord"),
    "µ": ("μ", "ord"),
}

# Commands that stand for one plain character.
ESCAPES = {"%": "%", "#": "#", "&": "&", "$": "$", "_": "_"}

FUNCTIONS = _words(
    """
    arccos arcsin arctan arccot arcsec arccsc arg cos cosh cot coth csc csch sec sech deg dim exp hom ker lg ln log sin
    sinh tan tanh arsinh arcosh artanh arcoth sgn sign tr Tr rank diag erf erfc sinc Var Cov
    """
)
LIMIT_FUNCTIONS = {
    **{name: name for name in ("det", "gcd", "inf", "lim", "max", "min", "sup", "Pr")},
    "limsup": "lim sup",
    "liminf": "lim inf",
    "injlim": "inj lim",
    "projlim": "proj lim",
    "argmin": "arg min",
    "argmax": "arg max",
}

SPACES = {
    ",": 3 / 18,
    "thinspace": 3 / 18,
    ":": 4 / 18,
    ">": 4 / 18,
    "medspace": 4 / 18,
    ";": 5 / 18,
    "thickspace": 5 / 18,
    "!": -3 / 18,
    "negthinspace": -3 / 18,
    "negmedspace": -4 / 18,
    "negthickspace": -5 / 18,
    " ": 1 / 3,
    "space": 1 / 3,
    "nobreakspace": 1 / 3,
    "enspace": 0.5,
    "enskip": 0.5,
    "quad": 1.0,
    "qquad": 2.0,
}
# Units of \hspace, \kern and \mspace, in em of a 10 pt font.
UNITS = {"em": 1.0, "ex": 0.43, "mu": 1 / 18, "pt": 0.1, "mm": 0.28453, "cm": 2.8453, "in": 7.227, "pc": 1.2}

PRIMES = {1: "′", 2: "″", 3: "‴", 4: "⁗"}

# name: (combining character for Typst, spacing character for MathML)
ACCENTS = {
    "hat": ("\u0302", "^"),
    "tilde": ("\u0303", "~"),
    "bar": ("\u0304", "¯"),
    "breve": ("\u0306", "˘"),
    "dot": ("\u0307", "˙"),
    "ddot": ("\u0308", "¨"),
    "dddot": ("\u20db", "⃛"),
    "ddddot": ("\u20dc", "⃜"),
    "mathring": ("\u030a", "˚"),
    "check": ("\u030c", "ˇ"),
    "acute": ("\u0301", "´"),
    "grave": ("\u0300", "`"),
    "vec": ("\u20d7", "→"),
}
WIDE_ACCENTS = {
    "widehat": "hat",
    "widetilde": "tilde",
    "widecheck": "check",
    "overrightarrow": "overrightarrow",
    "overleftarrow": "overleftarrow",
    "overleftrightarrow": "overleftrightarrow",
}
ACCENTS |= {
    "overrightarrow": ("\u20d7", "→"),
    "overleftarrow": ("\u20d6", "←"),
    "overleftrightarrow": ("\u20e1", "↔"),
}
BRACES = {
    "overbrace": ("⏞", True),
    "underbrace": ("⏟", False),
    "overbracket": ("⎴", True),
    "underbracket": ("⎵", False),
    "overparen": ("⏜", True),
    "underparen": ("⏝", False),
}
LONG_ARROWS = {
    "xrightarrow": "→",
    "xleftarrow": "←",
    "xleftrightarrow": "↔",
    "xRightarrow": "⇒",
    "xLeftarrow": "⇐",
    "xLeftrightarrow": "⇔",
    "xmapsto": "↦",
    "xhookrightarrow": "↪",
    "xhookleftarrow": "↩",
}

# The alphabets: command -> variant of `alphabets`.
FONTS = {
    "mathrm": "normal",
    "mathup": "normal",
    "mathbf": "bold",
    "mathit": "italic",
    "mathnormal": "",
    "mathcal": "script",
    "mathscr": "roundhand",
    "mathbb": "double",
    "mathfrak": "fraktur",
    "mathsf": "sans",
    "mathtt": "mono",
    "boldsymbol": "boldsymbol",
    "bm": "boldsymbol",
    "pmb": "boldsymbol",
    "mathbfit": "boldsymbol",
    "bold": "bold",
    "Bbb": "double",
    "mathds": "double",
    "mathbbm": "double",
}
FONT_SWITCHES = {
    "rm": "normal",
    "bf": "bold",
    "it": "italic",
    "sf": "sans",
    "tt": "mono",
    "cal": "script",
    "frak": "fraktur",
    "mit": "italic",
    "scr": "script",
}
TEXT_FONTS = {
    "text": "normal",
    "textrm": "normal",
    "textnormal": "normal",
    "textup": "normal",
    "mbox": "normal",
    "hbox": "normal",
    "textbf": "bold",
    "textit": "italic",
    "emph": "italic",
    "texttt": "mono",
    "textsf": "sans",
    "textsc": "normal",
    "textsl": "italic",
    "textmd": "normal",
}
STYLES = {"displaystyle": "display", "textstyle": "text", "scriptstyle": "script", "scriptscriptstyle": "sscript"}
CLASSES = {f"math{cls}": cls for cls in ("ord", "op", "bin", "rel", "open", "close", "punct")} | {"mathinner": "ord"}

SYMBOLS: dict[str, tuple[str, str]] = {
    **{name: (char, "ord") for table in (ORDINARY, DOTS, BARS) for name, char in table.items()},
    **{name: (char, "bin") for name, char in BINARY.items()},
    **{name: (char, "rel") for table in (RELATIONS, ARROWS) for name, char in table.items()},
    **{name: (char, "open") for name, char in OPENING.items()},
    **{name: (char, "close") for name, char in CLOSING.items()},
    **{name: (char, "ord") for name, char in ESCAPES.items()},
    "colon": (":", "punct"),
    "ldotp": (".", "punct"),
    "cdotp": ("⋅", "punct"),
    "lbrace": ("{", "open"),
    "lq": ("‘", "ord"),
    "rq": ("’", "ord"),
    "vline": ("|", "ord"),
}
