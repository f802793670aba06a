#pragma once

// Sines, arctangents and logarithms from sums, products and quotients only, whose digits IEEE 754 fixes.
// Those of the standard library differ between machines: glibc has several versions, with and without fused
// multiply-add. So plans are the same on all machines; nothing else in core/, api/ and library/ may call the
// standard ones.
//
// Errors are below one unit in the last place (two for logarithms and powers).

#include "core/geometry/elementary_functions.h"
#include "core/geometry/position.h"

namespace fleetplan::core {

/// The sine and the cosine of an angle in radians, at most 1e6 from 0.
double sine(double angle);
double cosine(double angle);

/// The unit vector at an angle from +x.
Position unit_vector(double angle);

/// The angle of (x, y) from +x in [-pi, pi], as std::atan2 has it. Finite arguments; 0 or pi for the origin.
double arctangent(double y, double x);

/// The angle of a vector from +x, in (-pi, pi]; 0 for no vector.
double heading_of(const Position& vector);

/// The natural logarithm of a positive normal number.
double natural_logarithm(double x);

/// 2 to the power of a number between -1000 and 1000.
double power_of_two(double exponent);

}  // namespace fleetplan::core
