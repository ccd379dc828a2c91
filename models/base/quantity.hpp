#pragma once

#include "models/base/document_tree.hpp"
#include "models/base/parameter.hpp"

namespace kerf {

/// The number at `node` in consistent units. Throws std::invalid_argument when it is not what `parameter` declares
/// (bare number for a dimensional key, wrong dimension, out of range, not finite, ...); the message is a predicate that
/// follows `key = value`: "is above 1000 MPa (allowed: 0.001 to 1000 MPa); did you mean MPa?".
double read_number(const Node& node, const Parameter& parameter);

/// `number` given in `unit`, in consistent units; throws as above when it is not a unit that `parameter` allows, or
/// when the value is outside the parameter's range.
double in_range(double number, std::string_view unit, const Parameter& parameter);

/// What a file would hold for `value` (consistent units): `read_number` turns it back into the same double. In the
/// parameter's own unit where that is possible.
Node::Value write_number(double value, const Parameter& parameter);

/// ` or ""`: the unit a user may have meant by the word `unit`, among the usual ones of the dimension of `expected`.
std::string unit_hint(std::string_view unit, std::string_view expected);

/// What kind of value stands at `node`, in words: "a string", "a table".
std::string kind_of(const Node& node);

}  // namespace kerf
