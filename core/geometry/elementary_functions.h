#pragma once

// Sines, arctangents and logarithms computed only with sums, products and quotients, whose digits IEEE 754
// fixes. The functions of the standard library differ between machines: glibc has several versions, with and
// without fused multiply-add. With the functions here, plans are the same on all machines. No other code in
// core/, api/ and library/ may call the standard functions.
//
// Errors are below one unit in the last place (two for logarithms and powers).

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"

namespace fleetplan::core {

/// The sine and the cosine of an angle in radians, between -1e6 and 1e6.
double sine(double angle);
double cosine(double angle);

/// The unit vector at an angle from +x.
Position unit_vector(double angle);

/// The angle of (x, y) from +x in [-pi, pi], as in std::atan2. Finite arguments. For the origin, 0 or pi.
double arctangent(double y, double x);

/// The angle of a vector from +x, in (-pi, pi]; 0 for the zero vector.
double heading_of(const Position& vector);

/// The natural logarithm of a positive normal number.
double natural_logarithm(double x);

/// 2 to the power of a number between -1000 and 1000.
double power_of_two(double exponent);

}  // namespace fleetplan::core
