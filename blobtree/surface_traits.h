// How a surface point came about: cut, ridge or dent, carried up the tape beside the value. Private to blobtree/.
#pragma once

#include "blobtree/field.h"

namespace cambium {

struct TraitedValue {
  double f = 0;
  SurfaceTraits traits;
};

TraitedValue sum_of(const TraitedValue* f, std::size_t n);
TraitedValue max_of(const TraitedValue* f, std::size_t n, bool with_zero);
TraitedValue min_of(const TraitedValue* f, std::size_t n, bool with_zero);
TraitedValue difference_of(const TraitedValue& first, const TraitedValue* taken, std::size_t n, bool capped);
TraitedValue ricci_of(const TraitedValue* f, std::size_t n, double exponent);
TraitedValue contact_of(const TraitedValue* f, std::size_t n, bool with_zero, double width, double lip);
TraitedValue fork_of(const TraitedValue& axis, const TraitedValue* f, const TraitedValue* weights, std::size_t n, bool with_zero,
                     double width, double lip);
TraitedValue scaled(const TraitedValue& f, double factor);

}  // namespace cambium
