"""PAC2002 written out as printed (Pacejka, Tyre and Vehicle Dynamics, 2nd ed., 4.3.2; Adams/Tire
help): angles by atan and cos, forces multiplied by the load at once, no identities. Prints the tables
of tests/model/pac2002_test.cc, the second with every scale factor other than one:  python3 tests/reference/pac2002_longhand.py examples/tires/paper_sedan.tir
"""

import sys
from math import atan, cos, exp, pi, sin, sqrt, tan

STATES = [  # load, kappa, alpha, camber, speed
    (3928.5, 0.0, 0.0, 0.0, 20.0),
    (4207.0, 0.012, 0.0, 0.0, 20.0),
    (4207.0, 0.012, 0.002, 0.01, 20.0),
    (1459.0, -0.03, -0.015, -0.02, 20.0),
    (2500.0, 0.1, 0.0, 0.03, 3.0),
    (2500.0, -0.25, 0.08, 0.0, 3.0),
    (9000.0, 0.05, -0.12, 0.05, 30.0),
    (9000.0, -0.8, 0.3, -0.05, 10.0),
    (500.0, 0.02, 0.04, 0.0, -5.0),
    (14000.0, 0.03, 0.01, 0.0, 20.0),
    (100.0, -0.02, -0.01, 0.0, 20.0),
    (4000.0, 0.0, 0.1, 0.0, 20.0),
]

SCALES = dict(
    LFZO=0.95, LCX=1.03, LMUX=0.85, LEX=0.9, LKX=1.1, LHX=1.2, LVX=0.8, LGAX=1.15, LCY=0.97, LMUY=0.9,
    LEY=1.05, LKY=0.93, LHY=0.75, LVY=1.25, LGAY=0.85, LTR=1.12, LRES=0.7, LGAZ=1.3, LXAL=0.88, LYKA=1.07,
    LVYKA=1.4, LS=0.6, LMX=1.35, LVMX=0.65, LMY=1.45)


def read(path):
    p = {}
    for line in open(path):
        line = line.split("$")[0]
        if "=" in line:
            key, value = line.split("=")
            try:
                p[key.strip()] = float(value)
            except ValueError:
                pass
    return p


def sgn(x):
    return -1.0 if x < 0 else 1.0


def tire(p, Fz, kappa, alpha, gamma, V):
    g = lambda name: p.get(name, 1.0 if name.startswith("L") else 0.0)
    R0, Fz0 = g("UNLOADED_RADIUS"), g("FNOMIN")
    Fz0p = g("LFZO") * Fz0
    Fzc = min(max(Fz, g("FZMIN")), g("FZMAX"))  # characteristics held outside the range
    dfz = (Fzc - Fz0p) / Fz0p

    gx = gamma * g("LGAX")
    SHx = (g("PHX1") + g("PHX2") * dfz) * g("LHX")
    SVx = Fz * (g("PVX1") + g("PVX2") * dfz) * g("LVX") * g("LMUX")
    kx = kappa + SHx
    Cx = g("PCX1") * g("LCX")
    mux = (g("PDX1") + g("PDX2") * dfz) * (1 - g("PDX3") * gx**2) * g("LMUX")
    Dx = mux * Fz
    Ex = min(1.0, (g("PEX1") + g("PEX2") * dfz + g("PEX3") * dfz**2) * (1 - g("PEX4") * sgn(kx)) * g("LEX"))
    Kx = Fz * (g("PKX1") + g("PKX2") * dfz) * exp(g("PKX3") * dfz) * g("LKX")
    Bx = Kx / (Cx * Dx)
    Fx0 = Dx * sin(Cx * atan(Bx * kx - Ex * (Bx * kx - atan(Bx * kx)))) + SVx

    gy = gamma * g("LGAY")
    SHy = (g("PHY1") + g("PHY2") * dfz) * g("LHY") + g("PHY3") * gy
    SVy = Fz * ((g("PVY1") + g("PVY2") * dfz) * g("LVY") + (g("PVY3") + g("PVY4") * dfz) * gy) * g("LMUY")
    ay = alpha + SHy
    Cy = g("PCY1") * g("LCY")
    muy = (g("PDY1") + g("PDY2") * dfz) * (1 - g("PDY3") * gy**2) * g("LMUY")
    Dy = muy * Fz
    Ey = min(1.0, (g("PEY1") + g("PEY2") * dfz) * (1 - (g("PEY3") + g("PEY4") * gy) * sgn(ay)) * g("LEY"))
    Ky = g("PKY1") * Fz0 * sin(2 * atan(Fzc / (g("PKY2") * Fz0p))) * (1 - g("PKY3") * abs(gy)) * g("LFZO") * g("LKY")
    Ky *= Fz / Fzc
    By = Ky / (Cy * Dy)
    Fy0 = Dy * sin(Cy * atan(By * ay - Ey * (By * ay - atan(By * ay)))) + SVy

    SHxa = g("RHX1")
    Bxa = g("RBX1") * cos(atan(g("RBX2") * kappa)) * g("LXAL")
    Cxa = g("RCX1")
    Exa = min(1.0, g("REX1") + g("REX2") * dfz)
    a_s = alpha + SHxa
    Dxa = Fx0 / cos(Cxa * atan(Bxa * SHxa - Exa * (Bxa * SHxa - atan(Bxa * SHxa))))
    Fx = Dxa * cos(Cxa * atan(Bxa * a_s - Exa * (Bxa * a_s - atan(Bxa * a_s))))

    SHyk = g("RHY1") + g("RHY2") * dfz
    Byk = g("RBY1") * cos(atan(g("RBY2") * (alpha - g("RBY3")))) * g("LYKA")
    Cyk = g("RCY1")
    Eyk = min(1.0, g("REY1") + g("REY2") * dfz)
    k_s = kappa + SHyk
    Dyk = Fy0 / cos(Cyk * atan(Byk * SHyk - Eyk * (Byk * SHyk - atan(Byk * SHyk))))
    DVyk = muy * Fz * (g("RVY1") + g("RVY2") * dfz + g("RVY3") * gamma) * cos(atan(g("RVY4") * alpha))
    SVyk = DVyk * sin(g("RVY5") * atan(g("RVY6") * kappa)) * g("LVYKA")
    Fy = Dyk * cos(Cyk * atan(Byk * k_s - Eyk * (Byk * k_s - atan(Byk * k_s)))) + SVyk

    gz = gamma * g("LGAZ")
    SHt = g("QHZ1") + g("QHZ2") * dfz + (g("QHZ3") + g("QHZ4") * dfz) * gz
    SHf = SHy + SVy / Ky
    at, ar = alpha + SHt, alpha + SHf
    at = atan(sqrt(tan(at) ** 2 + (Kx / Ky) ** 2 * kappa**2)) * sgn(at)
    ar = atan(sqrt(tan(ar) ** 2 + (Kx / Ky) ** 2 * kappa**2)) * sgn(ar)
    Bt = (g("QBZ1") + g("QBZ2") * dfz + g("QBZ3") * dfz**2) * (1 + g("QBZ4") * gz + g("QBZ5") * abs(gz)) * g("LKY") / g("LMUY")
    Ct = g("QCZ1")
    Dt = Fz * (g("QDZ1") + g("QDZ2") * dfz) * (1 + g("QDZ3") * gz + g("QDZ4") * gz**2) * (R0 / Fz0p) * g("LTR")
    Et = (g("QEZ1") + g("QEZ2") * dfz + g("QEZ3") * dfz**2) * (1 + (g("QEZ4") + g("QEZ5") * gz) * 2 / pi * atan(Bt * Ct * at))
    Et = min(1.0, Et)
    t = Dt * cos(Ct * atan(Bt * at - Et * (Bt * at - atan(Bt * at)))) * cos(alpha)
    Br = g("QBZ9") * g("LKY") / g("LMUY") + g("QBZ10") * By * Cy
    Dr = Fz * ((g("QDZ6") + g("QDZ7") * dfz) * g("LRES") + (g("QDZ8") + g("QDZ9") * dfz) * gz) * R0 * g("LMUY")
    Mzr = Dr * cos(atan(Br * ar)) * cos(alpha)
    s = (g("SSZ1") + g("SSZ2") * Fy / Fz0p + (g("SSZ3") + g("SSZ4") * dfz) * gamma) * R0 * g("LS")
    Mz = -t * (Fy - SVyk) + Mzr + s * Fx

    Mx = Fz * R0 * (g("QSX1") * g("LVMX") - g("QSX2") * gamma + g("QSX3") * Fy / Fz0) * g("LMX")
    v = abs(V) / g("LONGVL")
    My = -sgn(V) * Fz * R0 * (g("QSY1") + g("QSY2") * Fx / Fz0 + g("QSY3") * v + g("QSY4") * v**4) * g("LMY")
    return Fx, Fy, Mx, My, Mz, Kx


if __name__ == "__main__":
    parameters = read(sys.argv[1])
    # The overturning couple and the speed terms are zero in the file: given here to be tested.
    parameters.update(QSX1=0.01, QSX2=0.3, QSX3=0.05, QSY2=0.002, QSY3=0.001, QSY4=0.0001, PDX3=1.5, QBZ10=0.1)
    for scales in ({}, SCALES):
        parameters.update(scales)
        for state in STATES:
            row = ", ".join(f"{x:.15g}" for x in state + tire(parameters, *state))
            print("    {{" + row + "}},")
        print()
