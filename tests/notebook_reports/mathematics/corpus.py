"""Well over a thousand formulas as SymPy's LaTeX printer writes them, made from SymPy's own objects.

The generator is seeded: the corpus is the same in every run. Nothing is evaluated that takes time; what counts is
what the printer can write, not what the formulas mean.
"""

import random
from collections.abc import Iterator

import sympy as sp
from sympy import diffgeom, stats
from sympy.codegen.ast import Assignment
from sympy.combinatorics import Cycle, Permutation
from sympy.core.symbol import Str
from sympy.functions import combinatorial, elementary
from sympy.physics import quantum, vector
from sympy.physics.control import Feedback, Parallel, Series, StateSpace, TransferFunction, TransferFunctionMatrix
from sympy.physics.quantum.cg import CG, Wigner3j, Wigner6j, Wigner9j
from sympy.physics.units import kilogram, meter, second
from sympy.tensor.tensor import TensorHead, TensorIndexType, tensor_indices
from sympy.tensor.toperators import PartialDerivative
from sympy.vector import CoordSys3D, Cross, Curl, Divergence, Dot, Gradient, Laplacian

x, y, z, t, s, w = sp.symbols("x y z t s omega")
n, k, m = sp.symbols("n k m", integer=True)
a, b, c = sp.symbols("a b c", positive=True)
f, g = sp.Function("f"), sp.Function("g")


def _words(text: str) -> list[str]:
    return text.split()


def _named(text: str) -> list[type[sp.Function]]:
    return [getattr(sp, name) for name in text.split()]


NAMES = _words(
    """
x y K T_i T_d T_f K_p y_sp u_max alpha beta gamma delta epsilon varepsilon zeta eta theta vartheta iota kappa lamda mu
nu xi omicron pi varpi rho varrho sigma varsigma tau upsilon phi varphi chi psi omega Gamma Delta Theta Lambda Xi Pi
Sigma Upsilon Phi Psi Omega Alpha Beta x_1 x_12 x_i_j x__2 x_1__2 omega_0 omega__k_n xdot xddot xhat xbar xvec xtilde
xcheck xbreve xacute xgrave xprime alphahat betadot omegabar_1 Kbold xbm xcal Lscr gfrak Ibb xmag xnorm xavg xabs xdddot
xddddot aleph beth hbar hslash ell wp eth mho
    """
)
FUNCTIONS = _named(
    """
    sin cos tan cot sec csc asin acos atan acot asec acsc sinh cosh tanh coth sech csch asinh acosh atanh acoth
    asech acsch exp log sqrt cbrt Abs sign re im arg conjugate floor ceiling frac gamma loggamma digamma
    trigamma erf erfc erfi erfinv erfcinv Ei li Li Si Ci Shi Chi fresnels fresnelc airyai airybi airyaiprime
    airybiprime zeta dirichlet_eta elliptic_k elliptic_e factorial factorial2 subfactorial bernoulli euler
    fibonacci lucas harmonic catalan bell DiracDelta Heaviside LambertW sinc transpose adjoint riemann_xi
    stieltjes genocchi tribonacci
    """
)
FUNCTIONS += [elementary.exponential.exp_polar, combinatorial.numbers.partition]
FUNCTIONS_OF_TWO = _named(
    """
    besselj bessely besseli besselk hankel1 hankel2 jn yn atan2 beta lowergamma uppergamma polygamma binomial rf
    ff Max Min chebyshevt chebyshevu legendre hermite laguerre KroneckerDelta elliptic_f elliptic_pi polylog
    expint erf2 Mod harmonic root log zeta stieltjes bell bernoulli euler fibonacci
    """
)
OTHERS = [
    lambda: sp.jacobi(n, a, b, x),
    lambda: sp.gegenbauer(n, a, x),
    lambda: sp.assoc_legendre(n, m, x),
    lambda: sp.assoc_laguerre(n, a, x),
    lambda: sp.Ynm(n, m, sp.Symbol("theta"), sp.Symbol("phi")),
    lambda: sp.Znm(n, m, x, y),
    lambda: sp.LeviCivita(n, k, m),
    lambda: sp.hyper((1, a), (b, c), z),
    lambda: sp.hyper((), (), z),
    lambda: sp.meijerg([[1], [2, 3]], [[a], []], z),
    lambda: sp.appellf1(a, b, c, 1, x, y),
    lambda: sp.mathieuc(a, b, z),
    lambda: sp.mathieus(a, b, z),
    lambda: sp.mathieucprime(a, b, z),
    lambda: sp.elliptic_pi(n, m, x),
    lambda: sp.lerchphi(z, s, a),
    lambda: sp.marcumq(m, a, b),
    lambda: sp.SingularityFunction(x, a, n),
    lambda: sp.betainc(a, b, x, y),
    lambda: sp.betainc_regularized(a, b, x, y),
    lambda: sp.primepi(n),
    lambda: sp.primenu(n),
    lambda: sp.primeomega(n),
    lambda: sp.totient(n),
    lambda: sp.reduced_totient(n),
    lambda: sp.divisor_sigma(n, k),
    lambda: sp.jacobi_normalized(n, a, b, x),
]


def _expression(rng: random.Random, depth: int = 3) -> sp.Expr:
    """A random expression of the kinds that control theory and calculus write."""
    if depth == 0:
        return rng.choice([x, y, z, t, s, a, b, sp.Symbol(rng.choice(NAMES)), _number(rng)])
    one, two = _expression(rng, depth - 1), _expression(rng, depth - rng.randint(1, depth))
    return rng.choice(
        [
            lambda: sp.Add(one, two, evaluate=False),
            lambda: sp.Mul(one, two, evaluate=False),
            lambda: sp.Mul(one, sp.Pow(two, -1, evaluate=False), evaluate=False),
            lambda: sp.Pow(one, two, evaluate=False),
            lambda: sp.Pow(one, sp.Rational(1, rng.choice([2, 3, 4])), evaluate=False),
            lambda: sp.Pow(one, sp.Rational(-3, rng.choice([2, 4])), evaluate=False),
            lambda: one - two,
            lambda: one * two,
            lambda: one + two,
            lambda: -one,
            lambda: f(one) ** 2,
            lambda: sp.sin(one, evaluate=False) ** rng.choice([1, 2, -1]),
            lambda: sp.exp(one, evaluate=False),
            lambda: sp.log(one, evaluate=False),
            lambda: sp.Abs(one, evaluate=False),
        ]
    )()


def _number(rng: random.Random) -> sp.Expr:
    return rng.choice(
        [
            lambda: sp.Integer(rng.randint(-99, 99)),
            lambda: sp.Rational(rng.randint(-99, 99), rng.randint(1, 99)),
            lambda: sp.Rational(rng.getrandbits(90), rng.getrandbits(80) + 1),
            lambda: sp.Float(rng.uniform(-1e3, 1e3), 5),
            lambda: sp.Float(rng.uniform(1, 9) * 10 ** rng.randint(-30, 30), 6),
            lambda: rng.choice([sp.pi, sp.E, sp.I, sp.oo, -sp.oo, sp.zoo, sp.nan, sp.EulerGamma, sp.GoldenRatio]),
        ]
    )()


def _arithmetic(rng: random.Random) -> Iterator[sp.Basic]:
    for _ in range(420):
        yield _expression(rng, rng.randint(1, 3))
    for name in NAMES:
        yield sp.Symbol(name) ** 2 / sp.Symbol(name + "_1" if "_" not in name else name)
    for _ in range(40):
        yield _number(rng)
    for symbol in ("T_i", "omega_0"):
        yield sp.Mul(2, 3, sp.Symbol(symbol), evaluate=False) / sp.Pow(x + 1, sp.Rational(1, 3))


def _functions(rng: random.Random) -> Iterator[sp.Basic]:
    for function in FUNCTIONS:
        yield function(x, evaluate=False) if function is not sp.zeta else function(x)
        yield function(n / 2 + a) ** 2
    for function in FUNCTIONS_OF_TWO:
        yield function(n, x)
        yield function(n, x) ** 2 / 3
    for make in OTHERS:
        yield make()
        yield make() ** 2


def _calculus(rng: random.Random) -> Iterator[sp.Basic]:
    for _ in range(30):
        e = _expression(rng, 2)
        yield sp.Integral(e, x)
        yield sp.Integral(e, (x, 0, sp.oo))
        yield sp.Integral(e, (x, a, b), (y, -sp.oo, sp.oo))
        yield sp.Sum(e, (k, 0, n))
        yield sp.Product(e, (k, 1, sp.oo))
        yield sp.Derivative(e + f(x), x, evaluate=False)
        yield sp.Limit(e, x, rng.choice([0, sp.oo, a]), rng.choice(["+", "-", "+-"]))
    yield sp.Derivative(f(x, y), (x, 2), y)
    yield sp.Derivative(f(x), (x, n))
    yield sp.Integral(f(x, y, z), x, y, z)
    yield sp.Integral(f(x), (x, 0, 1), (y, 0, 1), (z, 0, 1), t)
    yield sp.Sum(k**2, (k, 1, n), (m, 1, k))
    yield sp.Product(k + m, (k, 1, n), (m, 1, n))
    yield sp.Subs(f(x), x, 0)
    yield sp.Subs(sp.Derivative(f(x, y), x), (x, y), (0, a / b))
    yield sp.O(x**3)
    yield sp.Order(x**2, (x, sp.oo))
    yield sp.Order(x * y, (x, 0), (y, 0))
    yield sp.sin(x).series(x, 0, 8)
    yield sp.Eq(sp.Derivative(f(t), t, 2) + 2 * sp.Symbol("zeta") * w * f(t).diff(t) + w**2 * f(t), 0)
    yield from (sp.Eq(f(x), _expression(rng, 2), evaluate=False) for _ in range(20))
    for relation in (sp.Ne, sp.Lt, sp.Le, sp.Gt, sp.Ge):
        yield relation(x, y + 1)


def _matrices(rng: random.Random) -> Iterator[sp.Basic]:
    for rows, columns in [(1, 1), (2, 2), (3, 3), (1, 4), (4, 1), (5, 5), (2, 3)] * 4:
        yield sp.Matrix(rows, columns, lambda i, j: _expression(rng, 1))
    A, B, C = sp.MatrixSymbol("A", n, n), sp.MatrixSymbol("B", n, n), sp.MatrixSymbol("Gamma_1", n, 1)
    yield from (A * B + A.T - 2 * B.I, (A + B) * C, A**2 * B ** (-1), sp.Trace(A * B), sp.Determinant(A), A[0, 1])
    yield from (A[k, m], sp.HadamardProduct(A, B), sp.HadamardPower(A, 2), sp.KroneckerProduct(A, B), sp.Adjoint(A))
    yield from (sp.BlockMatrix([[A, B], [B, A]]), sp.Identity(n), sp.ZeroMatrix(n, n), sp.OneMatrix(n, n), A[1:3, 0:2])
    yield from (sp.MatrixSlice(A, (0, n), (0, 2)), sp.Inverse(A + B), sp.Transpose(A * B), A.applyfunc(sp.sin))
    yield from (sp.DiagonalMatrix(A), sp.DotProduct(C, C), sp.Trace(A) ** 2, sp.Matrix([[1, 2]]).as_immutable())
    yield from (
        sp.Matrix([]),
        sp.Matrix(0, 3, []),
        sp.SparseMatrix(2, 2, {(0, 0): x}),
        sp.Determinant(sp.Matrix([[a, b], [c, 1]])),
    )
    yield from (
        sp.Array([[a, b], [c, 1]]),
        sp.Array([[[1, x], [y, z]], [[a, b], [c, 0]]]),
        sp.Array(5),
        sp.Array([1, x]),
    )
    yield from (
        sp.PermutationMatrix(Permutation([1, 0, 2])),
        sp.MatPow(A, n),
        sp.Matrix([[x]]) ** 2,
        -A,
        sp.Derivative(A * C, C),
    )
    yield from (sp.tensorproduct(sp.Array([x, y]), sp.Array([a, b])), sp.FunctionMatrix(2, 2, sp.Lambda((k, m), k + m)))


def _sets_and_logic(rng: random.Random) -> Iterator[sp.Basic]:
    p, q, r = sp.symbols("p q r")
    S1, S2 = sp.Interval(0, 1), sp.Interval.open(a, b)
    yield from (
        S1,
        S2,
        sp.Interval.Lopen(0, sp.oo),
        sp.Interval.Ropen(-sp.oo, a),
        sp.FiniteSet(1, x, a / b),
        sp.EmptySet,
    )
    yield from (
        sp.UniversalSet,
        sp.Union(S2, sp.FiniteSet(-5, x), evaluate=False),
        sp.Intersection(S2, sp.Interval(c, x)),
    )
    yield from (
        sp.Complement(sp.S.Reals, S1),
        sp.SymmetricDifference(S2, sp.Interval(x, y)),
        sp.ProductSet(S1, S2),
        S1**3,
    )
    yield from (sp.S.Naturals, sp.S.Naturals0, sp.S.Integers, sp.S.Rationals, sp.S.Reals, sp.S.Complexes)
    yield from (sp.Range(5), sp.Range(0, sp.oo, 2), sp.Range(n), sp.Range(sp.oo, 0, -1), sp.Range(-sp.oo, 4))
    yield from (sp.ImageSet(sp.Lambda(x, x**2), sp.S.Naturals), sp.ConditionSet(x, sp.Gt(sp.sin(x), 0), sp.S.Reals))
    yield from (
        sp.ConditionSet(x, sp.Eq(x**2, 2)),
        sp.ComplexRegion(S1 * S1),
        sp.ComplexRegion(S1 * sp.Interval(0, 2 * sp.pi), polar=True),
    )
    yield from (sp.Contains(x, S2), sp.PowerSet(sp.FiniteSet(x)), sp.DisjointUnion(S1, S2), sp.S.Reals - {0})
    yield from (sp.fourier_series(x, (x, -sp.pi, sp.pi)), sp.fps(sp.exp(x)), sp.SeqFormula(n**2, (n, 0, sp.oo)))
    yield from (
        sp.SeqPer((1, 2, x), (n, 0, sp.oo)),
        sp.SeqAdd(sp.SeqFormula(n), sp.SeqFormula(n**2)),
        sp.AccumBounds(-1, a),
    )
    yield from (
        p & q,
        p | q,
        ~p,
        p >> q,
        sp.Equivalent(p, q),
        sp.Xor(p, q),
        sp.Nand(p, q),
        sp.Nor(p, q),
        sp.ITE(p, q, r),
    )
    yield from (~(p & q) | (r >> p), sp.Not(sp.Equivalent(p, q | r)), (p | q) & (q | ~r), sp.true, sp.false)
    yield from (
        sp.And(x > 0, sp.Or(x < 1, sp.Eq(y, 2))),
        sp.Not(sp.Contains(x, S2)),
        sp.Q.positive(x),
        sp.Q.real(x) & sp.Q.prime(n),
    )
    for _ in range(30):
        e1, e2 = _expression(rng, 1), _expression(rng, 1)
        yield sp.Piecewise((e1, x > 0), (e2, sp.Eq(x, 0)), (0, True))
        yield sp.Piecewise((e1, (x >= 0) & (x < 1)), (e2, sp.Or(x > 2, y <= a)))
        yield sp.FiniteSet(e1, e2)


def _transforms(rng: random.Random) -> Iterator[sp.Basic]:
    kinds = [sp.LaplaceTransform, sp.InverseLaplaceTransform, sp.FourierTransform, sp.InverseFourierTransform]
    kinds += [
        sp.MellinTransform,
        sp.SineTransform,
        sp.InverseSineTransform,
        sp.CosineTransform,
        sp.InverseCosineTransform,
    ]
    for kind in kinds:
        for inner in (f(t), f(t) * sp.exp(-a * t), sp.Derivative(f(t), t)):
            yield kind(inner, t, s, None) if kind is sp.InverseLaplaceTransform else kind(inner, t, s)
    yield sp.InverseMellinTransform(f(s), s, x, a, b)
    G1, G2 = TransferFunction(a, s**2 + 2 * s + 1, s), TransferFunction(s + a, s - b, s)
    yield from (
        G1,
        Series(G1, G2),
        Parallel(G1, G2),
        Parallel(-G1, Series(G1, G2)),
        Feedback(G1, G2),
        Feedback(G1, G2, 1),
    )
    yield TransferFunctionMatrix([[G1, G2], [G2, G1]])
    yield StateSpace(sp.Matrix([[0, 1], [-a, -b]]), sp.Matrix([0, 1]), sp.Matrix([[1, 0]]), sp.Matrix([0]))
    for _ in range(20):
        num, den = sum(_number_plain(rng) * s**i for i in range(3)), sum(_number_plain(rng) * z**-i for i in range(4))
        yield num / (1 + den)


def _number_plain(rng: random.Random) -> sp.Expr:
    return sp.Rational(rng.randint(1, 99), rng.randint(1, 99))


def _polynomials_and_algebra(rng: random.Random) -> Iterator[sp.Basic]:
    for _ in range(15):
        coefficients = [_number_plain(rng) for _ in range(5)]
        yield sp.Poly(coefficients, x)
        yield sp.Poly(coefficients, x).as_expr() / sp.Poly(coefficients[:3], x).as_expr()
    yield sp.Poly(x * y + a, x, y)
    yield sp.Poly(x**2 + 1, x, modulus=7)
    yield sp.CRootOf(x**5 - x - 1, 0)
    yield sp.RootSum(sp.Poly(x**3 + x + 1, x), sp.Lambda(x, sp.log(x)), auto=False)
    yield sp.GroebnerBasis([x**2 - y, y - x], [x, y])
    ring, *_ = sp.ring("u,v", sp.QQ)
    yield from (sp.QQ, sp.ZZ, sp.RR, sp.CC, sp.GF(7), sp.QQ[x], sp.ZZ[x, y], sp.QQ.frac_field(x))
    yield from (
        ring(1) + ring.gens[0] ** 2,
        sp.QQ.old_poly_ring(x).ideal(x**2),
        sp.QQ.old_poly_ring(x) / [x**2],
        sp.QQ.old_poly_ring(x).free_module(2),
    )
    yield from (
        sp.Lambda(x, x**2),
        sp.Lambda((x, y), x + y),
        sp.Lambda(x, sp.Piecewise((1, x > 0), (0, True))),
        sp.Tuple(x, y, 1),
    )
    yield from (
        sp.Dict({x: 1, y: a / b}),
        sp.UnevaluatedExpr(x + 1) ** 2,
        Cycle(1, 2, 3),
        Permutation([2, 0, 1]),
        sp.GoldenRatio,
    )
    yield from (
        sp.TribonacciConstant,
        sp.Catalan,
        sp.Wild("w"),
        sp.Dummy("d"),
        sp.Indexed("A", n, k),
        sp.IndexedBase("y")[k - 1] ** 2,
    )
    yield from (
        sp.Idx("i", (0, n)),
        Assignment(x, y + 1),
        Str("name"),
        sp.Point(1, a),
        sp.Line((0, 0), (1, 1)),
        sp.Circle((0, 0), a),
    )
    yield from (
        sp.Quaternion(1, x, -y, z),
        sp.MatrixSymbol("x", 2, 1).as_explicit(),
        sp.oo - x,
        sp.zoo,
        sp.Mod(x + 1, 3),
        x % y,
    )


def _physics(rng: random.Random) -> Iterator[sp.Basic]:
    ket, bra = quantum.Ket("psi"), quantum.Bra("phi")
    A, B = quantum.Operator("A"), quantum.Operator("B")
    yield from (
        ket,
        bra,
        bra * ket,
        ket * bra,
        quantum.Commutator(A, B),
        quantum.AntiCommutator(A, B),
        quantum.Dagger(A),
    )
    yield from (
        quantum.TensorProduct(A, B),
        A * B**2,
        quantum.InnerProduct(bra, ket),
        quantum.HilbertSpace(),
        quantum.ComplexSpace(2),
    )
    yield from (
        Wigner3j(1, 2, 3, 0, 0, 0),
        Wigner6j(1, 2, 3, 1, 2, 3),
        Wigner9j(1, 2, 3, 1, 2, 3, 1, 2, 3),
        CG(1, 0, 1, 0, 2, 0),
    )
    yield from (5 * meter / second**2, 3 * kilogram * meter, sp.physics.units.degree * 30, sp.physics.units.hbar)
    N = CoordSys3D("N")
    v = N.x * N.i + 2 * N.y * N.j - N.k
    yield from (
        v,
        -v,
        Cross(v, N.i),
        Dot(v, N.j),
        Gradient(N.x * N.y),
        Divergence(v),
        Curl(v),
        Laplacian(N.x**2),
        N.i | N.j,
        N.origin,
    )
    R = vector.ReferenceFrame("R")
    q = vector.dynamicsymbols("q1:4")
    yield from (q[0] * R.x + q[1].diff() * R.y, R.x | R.y, vector.Dyadic(0), q[2].diff(vector.dynamicsymbols._t, 2))
    L = TensorIndexType("L", dummy_name="L")
    i0, i1, i2 = tensor_indices("i0 i1 i2", L)
    H, P = TensorHead("H", [L, L]), TensorHead("P", [L])
    yield from (
        H(i0, -i1),
        H(i0, i1) * P(-i1),
        H(i0, i1) + P(i0) * P(i1),
        3 * H(-i0, -i1),
        L.metric(i0, i1),
        L.delta(i0, -i1),
    )
    yield from (PartialDerivative(P(i0), P(i1)), H(i0, -i0), P(i2) * 2)
    die, normal = stats.Die("X", 6), stats.Normal("Y", 0, 1)
    yield from (
        stats.Probability(die > 3),
        stats.Expectation(normal**2),
        stats.Variance(normal),
        stats.Covariance(normal, die),
    )
    yield from (stats.Expectation(normal, normal > 0), stats.rv.RandomSymbol("Z"))
    manifold = diffgeom.Manifold("M", 2)
    patch = diffgeom.Patch("P", manifold)
    system = diffgeom.CoordSystem("C", patch, [x, y])
    basis, forms = system.base_vectors(), system.base_oneforms()
    yield from (
        manifold,
        patch,
        basis[0],
        forms[0],
        diffgeom.WedgeProduct(*forms),
        diffgeom.TensorProduct(*forms),
        system.base_scalar(0),
    )


SETTINGS = [
    {},
    {"mode": "inline", "fold_short_frac": True},
    {"mat_delim": "(", "mul_symbol": "dot", "ln_notation": True, "inv_trig_style": "full"},
    {"mul_symbol": "times", "inv_trig_style": "power", "fold_func_brackets": True, "imaginary_unit": "rj"},
    {
        "decimal_separator": "comma",
        "root_notation": False,
        "mat_str": "array",
        "diff_operator": "rd",
        "gothic_re_im": True,
    },
    {
        "long_frac_ratio": 2,
        "adjoint_style": "hermitian",
        "fold_frac_powers": True,
        "parenthesize_super": False,
        "order": "rev-lex",
    },
]


def formulas(seed: int = 20260101) -> list[str]:
    """Distinct LaTeX formulas, always the same for one seed."""
    rng = random.Random(seed)
    found: dict[str, None] = {}
    kinds = [
        _arithmetic,
        _functions,
        _calculus,
        _matrices,
        _sets_and_logic,
        _transforms,
        _polynomials_and_algebra,
        _physics,
    ]
    for kind in kinds:
        for number, expression in enumerate(kind(rng)):
            settings = [SETTINGS[0], SETTINGS[1 + number % (len(SETTINGS) - 1)]]
            for options in settings:
                found[sp.latex(expression, **options).strip("$")] = None
    return list(found)
