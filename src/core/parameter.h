// Parameters declared once: a struct with defaults and a table of its members, from which flags, JSON and docs are made.
#pragma once

namespace duo {

template <class Params>
struct Parameter {
  const char* name;
  int Params::*member;
  const char* unit;
  int min, max;
  const char* help;
};

}  // namespace duo
