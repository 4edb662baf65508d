#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes cahv_reference.inc: pixels and rays of invented CAHV, CAHVOR and CAHVORE cameras.

Computed with 50 digits from the published mathematics (Yakimovsky & Cunningham 1978; Gennery,
"Generalized Camera Calibration Including Fish-Eye Lenses", IJCV 2006), vector by vector in the
reference frame: no camera frame, no closed forms, roots by bisection. Needs mpmath.
"""
import mpmath as mp

mp.mp.dps = 50


def vec(*values):
    return [mp.mpf(str(v)) for v in values]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def add(a, b, k=1):
    return [x + k * y for x, y in zip(a, b)]


def scale(a, k):
    return [x * k for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return scale(a, 1 / mp.sqrt(dot(a, a)))


def bisect(f, low, high):
    assert f(low) <= 0 <= f(high)
    for _ in range(180):
        middle = (low + high) / 2
        if f(middle) < 0:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def even(c, s):
    return c[0] + c[1] * s + c[2] * s * s


def chi_of(L, theta):
    if L > 0:
        return mp.tan(L * theta) / L
    if L < 0:
        return mp.sin(L * theta) / L
    return theta


def project(cam, p):
    d = add(p, cam["C"], -1)
    if cam["model"] == "kCahvor":
        w = dot(d, cam["O"])
        lam = add(d, cam["O"], -w)
        d = add(d, lam, even(cam["R"], dot(lam, lam) / w**2))
    if cam["model"] == "kCahvore":
        z = dot(d, cam["O"])
        lam = add(d, cam["O"], -z)
        l = mp.sqrt(dot(lam, lam))
        def f(t):
            return z * mp.sin(t) - l * mp.cos(t) - (t - mp.sin(t)) * even(cam["E"], t * t)
        start = mp.atan2(l, z)
        theta = bisect(f, max(start - mp.mpf("0.3"), mp.mpf(0)), start + mp.mpf("0.3"))
        chi = chi_of(cam["L"], theta)
        d = add(scale(cam["O"], l / chi), lam, 1 + even(cam["R"], chi * chi))
    return dot(d, cam["H"]) / dot(d, cam["A"]), dot(d, cam["V"]) / dot(d, cam["A"])


def back(cam, x, y):
    """Origin and unit direction of a pixel's ray."""
    ray = cross(add(cam["V"], cam["A"], -y), add(cam["H"], cam["A"], -x))
    if dot(ray, cam["A"]) < 0:
        ray = scale(ray, -1)
    if cam["model"] == "kCahv":
        return cam["C"], unit(ray)
    z = dot(ray, cam["O"])
    lam = add(ray, cam["O"], -z)
    l = mp.sqrt(dot(lam, lam))
    def radius(c):
        return c * (1 + even(cam["R"], c * c)) - l / z
    high = mp.mpf(0)
    while radius(high) < 0:  # the first crossing is the lens's; the polynomial may turn back later
        high += mp.mpf("0.05")
    chi = bisect(radius, mp.mpf(0), high)
    outwards = unit(lam)
    if cam["model"] == "kCahvor":
        return cam["C"], unit(add(cam["O"], outwards, chi))
    L = cam["L"]
    theta = mp.atan(L * chi) / L if L > 0 else (mp.asin(L * chi) / L if L < 0 else chi)
    s = (theta / mp.sin(theta) - 1) * even(cam["E"], theta * theta)
    return add(cam["C"], cam["O"], s), add(scale(cam["O"], mp.cos(theta)), outwards, mp.sin(theta))


def camera(model, width, height, c, a, right, fx, fy, cx, cy, skew=0, o_off=(0, 0), r=(0, 0, 0),
           e=(0, 0, 0), kind=1, parameter=1):
    a = unit(vec(*a))
    right = unit(add(vec(*right), a, -dot(vec(*right), a)))
    down = cross(a, right)
    r6 = lambda v: [mp.mpf(mp.nstr(x, 9)) for x in v]  # as labels: rounded
    h = add(scale(right, mp.mpf(str(fx))), a, mp.mpf(str(cx)))
    v = add(add(scale(down, mp.mpf(str(fy))), right, mp.mpf(str(skew))), a, mp.mpf(str(cy)))
    o = unit(add(add(a, right, mp.mpf(str(o_off[0]))), down, mp.mpf(str(o_off[1]))))
    L = {1: mp.mpf(1), 2: mp.mpf(0), 3: mp.mpf(str(parameter))}[kind]
    # Unit vectors of the reference are of length 1 to 50 digits in what is computed, and rounded to
    # doubles in what is written: 1e-16.
    return dict(model=model, width=width, height=height, C=vec(*c), A=a, H=r6(h), V=r6(v), O=o,
                R=vec(*r), E=vec(*e), L=L, kind=kind, parameter=parameter)


CAMERAS = {
    "Mast": camera("kCahv", 1024, 900, (0.71, 0.42, -1.93), (0.8, -0.3, 0.52), (0.3, 0.9, 0.05),
                   1180.5, 1179.25, 511.3, 447.8),
    "SkewMirrored": camera("kCahv", 1024, 900, (-0.2, 0.1, 0.3), (0.1, 0.9, 0.4), (0.95, -0.1, 0.1),
                           1180.5, -1100.25, 480.3, 470.8, skew=37.5),
    "Pan": camera("kCahvor", 1024, 1024, (0.45, 0.23, -1.2), (0.6, 0.1, 0.79), (-0.2, 0.97, 0.1),
                  2960.0, 2961.5, 515.0, 507.0, o_off=(0.0031, -0.0042), r=(0.00003, -0.127, 0.31)),
    "Wide": camera("kCahvor", 1280, 960, (0.45, 0.23, -1.2), (0.6, 0.1, -0.79), (-0.2, 0.97, 0.1),
                   1021.0, 1033.5, 655.0, 467.0, skew=-4.0, o_off=(-0.011, 0.006),
                   r=(-0.0021, -0.21, 0.052)),
    "Fisheye": camera("kCahvore", 1288, 968, (0.57, 0.46, -1.94), (-0.81, 0.53, 0.24),
                      (-0.5, -0.82, 0.02), 1474.0, 1476.0, 641.0, 489.0, o_off=(0.002, -0.001),
                      r=(0.0000004, 0.052, -0.0187), e=(0.00021, -0.0001, 0.00004), kind=2),
    "Hazard": camera("kCahvore", 1024, 1024, (1.03, -0.17, -0.71), (0.7, 0.003, 0.71),
                     (-0.01, 1.0, 0.02), 560.0, 561.5, 508.0, 517.0, o_off=(0.002, 0.0025),
                     r=(0.000008, -0.0134, -0.0073), e=(0.0019, 0.0016, 0.0017), kind=3,
                     parameter=0.37),
    "HazardDeepPupil": camera("kCahvore", 1600, 1200, (1.09, -0.09, -0.74), (0.88, -0.17, 0.43),
                              (0.2, 0.97, 0.02), 905.0, 907.0, 803.0, 597.0, o_off=(-0.001, 0.0012),
                              r=(0.000002, 0.0075, -0.0056), e=(0.026, 0.0004, -0.0045), kind=3,
                              parameter=0.37),
    "PerspectivePupil": camera("kCahvore", 1280, 1024, (0.3, 0.1, 0.2), (0.1, 0.2, 0.97),
                               (1.0, 0.0, 0.1), 980.0, 981.0, 640.0, 511.0, o_off=(0.004, 0.003),
                               r=(0.001, -0.11, 0.02), e=(0.004, 0.002, -0.001), kind=1),
    "NegativeLinearity": camera("kCahvore", 1280, 1024, (0.3, 0.1, 0.2), (-0.1, 0.2, 0.97),
                                (1.0, 0.0, 0.1), 700.0, 705.0, 640.0, 511.0, o_off=(0.004, -0.003),
                                r=(0.0005, 0.01, 0.003), e=(0.004, 0.002, -0.001), kind=3,
                                parameter=-0.55),
}


def text(values):
    return "{" + ", ".join(mp.nstr(v, 17) for v in values) + "}"


def main():
    state = 12345
    for name, cam in CAMERAS.items():
        print('{"%s",' % name)
        cahv = [text(cam[k]) for k in "CAHVORE"]
        print(" {CameraModel::%s, %s, %d, %s}, %d, %d," %
              (cam["model"], ", ".join(cahv), cam["kind"], cam["parameter"], cam["width"],
               cam["height"]))
        print(" {")
        for i in range(9):
            if i == 0:
                x, y = mp.mpf(0), mp.mpf(0)
            elif i == 1:
                x, y = mp.mpf(cam["width"] - 1), mp.mpf(cam["height"] - 1)
            else:
                state = (state * 1103515245 + 12345) % 2**31
                x = mp.mpf(state % cam["width"]) + mp.mpf("0.25")
                state = (state * 1103515245 + 12345) % 2**31
                y = mp.mpf(state % cam["height"]) - mp.mpf("0.375")
            origin, direction = back(cam, x, y)
            depth = mp.mpf("0.15") * (1 + i) ** 2
            point = add(origin, direction, depth)
            again = project(cam, point)
            assert abs(again[0] - x) < mp.mpf("1e-30") and abs(again[1] - y) < mp.mpf("1e-30")
            print("  {%s, %s, %s, %s}," % (text((x, y)), text(origin), text(direction), text(point)))
        print(" }},")


if __name__ == "__main__":
    main()
