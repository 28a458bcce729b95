// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace sheen::core {

/// A number with its derivatives by two variables (forward differentiation).
struct Dual {
  double value = 0;
  double dx = 0;
  double dy = 0;

  Dual() = default;
  explicit(false) Dual(double constant) : value(constant) {}
  Dual(double v, double by_x, double by_y) : value(v), dx(by_x), dy(by_y) {}
};

inline Dual operator+(const Dual& a, const Dual& b) {
  return {a.value + b.value, a.dx + b.dx, a.dy + b.dy};
}
inline Dual operator*(const Dual& a, const Dual& b) {
  return {a.value * b.value, a.dx * b.value + a.value * b.dx, a.dy * b.value + a.value * b.dy};
}
inline Dual operator+(double a, const Dual& b) {
  return {a + b.value, b.dx, b.dy};
}
inline Dual operator*(double a, const Dual& b) {
  return {a * b.value, a * b.dx, a * b.dy};
}
inline Dual operator*(const Dual& a, double b) {
  return b * a;
}
inline Dual operator/(const Dual& a, const Dual& b) {
  const double quotient = a.value / b.value;
  return {quotient, (a.dx - quotient * b.dx) / b.value, (a.dy - quotient * b.dy) / b.value};
}
inline Dual sqrt(const Dual& a) {
  const double root = std::sqrt(a.value);
  return {root, a.dx / (2 * root), a.dy / (2 * root)};
}
inline Dual atan(const Dual& a) {
  const double slope = 1 / (1 + a.value * a.value);
  return {std::atan(a.value), slope * a.dx, slope * a.dy};
}

}  // namespace sheen::core
