# SPDX-License-Identifier: MIT
# A flight in closed form as two tables: ned.csv in NED and FRD, SI units, PX4's motor order; enu.csv, the same flight in ENU and
# FLU, degrees, g, millimetres, microseconds, pulse widths and Betaflight's motor order. The motors are `lag` seconds ahead of
# the motion that they cause.
#   awk -v rows=2000 -v lag=0.04 -v ned=ned.csv -v enu=enu.csv -f flight.awk
function phi(t) { return 0.25 * sin(1.7 * t) + 0.08 * sin(7.1 * t + 1) }
function theta(t) { return 0.2 * sin(1.3 * t + 0.5) + 0.07 * sin(8.3 * t) }
function psi(t) { return 0.3 * sin(0.7 * t) + 0.05 * sin(5.3 * t) }
function d(f, t, h) {
  h = 1e-4
  if (f == "phi") return (phi(t + h) - phi(t - h)) / (2 * h)
  if (f == "theta") return (theta(t + h) - theta(t - h)) / (2 * h)
  return (psi(t + h) - psi(t - h)) / (2 * h)
}
function p(t) { return d("phi", t) - d("psi", t) * sin(theta(t)) }
function q(t) { return d("theta", t) * cos(phi(t)) + d("psi", t) * cos(theta(t)) * sin(phi(t)) }
function r(t) { return -d("theta", t) * sin(phi(t)) + d("psi", t) * cos(theta(t)) * cos(phi(t)) }
function p_dot(t, h) { h = 1e-3; return (p(t + h) - p(t - h)) / (2 * h) }
function q_dot(t, h) { h = 1e-3; return (q(t + h) - q(t - h)) / (2 * h) }
function r_dot(t, h) { h = 1e-3; return (r(t + h) - r(t - h)) / (2 * h) }
# sets f[1..3]: specific force, body
function force(t, f, an, ae, ad, cr, sr, cp, sp, cy, sy) {
  an = 1.8 * cos(0.9 * t)
  ae = -0.9 * sin(0.6 * t)
  ad = 0.4 * cos(0.8 * t) + 1.5 * sin(4.1 * t) - 9.80665
  cr = cos(phi(t)); sr = sin(phi(t)); cp = cos(theta(t)); sp = sin(theta(t)); cy = cos(psi(t)); sy = sin(psi(t))
  f[1] = cp * cy * an + cp * sy * ae - sp * ad
  f[2] = (sr * sp * cy - cr * sy) * an + (sr * sp * sy + cr * cy) * ae + sr * cp * ad
  f[3] = (cr * sp * cy + sr * sy) * an + (cr * sp * sy - sr * cy) * ae + cr * cp * ad
}
BEGIN {
  OFMT = CONVFMT = "%.17g"
  print "t,roll,pitch,yaw,p,q,r,fx,fy,fz,vn,ve,vd,x,y,z,u1,u2,u3,u4,bat,label" >ned
  print "t_us,qx,qy,qz,qw,p_deg,q_deg,r_deg,gx,gy,gz,v_east,v_north,v_up,east,north,up,m1,m2,m3,m4,bat_mV,label" >enu
  degrees = 57.295779513082320877
  for (i = 0; i < rows; ++i) {
    t = i / 100
    force(t, f)
    vn = 2 * sin(0.9 * t); ve = 1.5 * cos(0.6 * t); vd = 0.5 * sin(0.8 * t) - 1.5 / 4.1 * cos(4.1 * t)
    x = -2 / 0.9 * cos(0.9 * t); y = 2.5 * sin(0.6 * t)
    z = -20 - 0.5 / 0.8 * cos(0.8 * t) - 1.5 / (4.1 * 4.1) * sin(4.1 * t)
    force(t + lag, g)
    c = -g[3] / 20; kx = p_dot(t + lag) / 160; ky = q_dot(t + lag) / 160; kz = r_dot(t + lag) / 80
    u1 = c - kx + ky + kz; u2 = c + kx - ky + kz; u3 = c + kx + ky - kz; u4 = c - kx - ky - kz
    battery = 12 - 0.01 * t
    print t "," phi(t) "," theta(t) "," psi(t) "," p(t) "," q(t) "," r(t) "," f[1] "," f[2] "," f[3] "," vn "," ve "," vd "," \
      x "," y "," z "," u1 "," u2 "," u3 "," u4 "," battery ",A1_wave_rep1" >ned
    # FRD -> NED as a quaternion, then FLU -> ENU: (0, s, s, 0) q (0, 1, 0, 0)
    cr = cos(phi(t) / 2); sr = sin(phi(t) / 2); cp = cos(theta(t) / 2); sp = sin(theta(t) / 2); cy = cos(psi(t) / 2); sy = sin(psi(t) / 2)
    w = cr * cp * cy + sr * sp * sy; a = sr * cp * cy - cr * sp * sy; b = cr * sp * cy + sr * cp * sy; e = cr * cp * sy - sr * sp * cy
    s = sqrt(0.5)
    w1 = -s * a - s * b; a1 = s * w + s * e; b1 = s * w - s * e; e1 = s * b - s * a
    w2 = -a1; a2 = w1; b2 = e1; e2 = -b1
    print i * 10000 "," a2 "," b2 "," e2 "," w2 "," p(t) * degrees "," (-q(t) * degrees) "," (-r(t) * degrees) "," f[1] / 9.80665 "," \
      (-f[2] / 9.80665) "," (-f[3] / 9.80665) "," ve * 1000 "," vn * 1000 "," (-vd * 1000) "," y "," x "," (-z) "," \
      (1000 + 1000 * u4) "," (1000 + 1000 * u1) "," (1000 + 1000 * u2) "," (1000 + 1000 * u3) "," battery * 1000 ",A1_wave_rep1" >enu
  }
}
