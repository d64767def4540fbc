// DUO_CHECK: a programmer's mistake (wrong sizes, wrong order of calls) ends the program with file and line.
#pragma once

#include <cstdio>
#include <cstdlib>

#define DUO_CHECK(condition)                                                                  \
  do {                                                                                        \
    if (!(condition)) {                                                                       \
      std::fprintf(stderr, "%s:%d: check failed: %s\n", __FILE__, __LINE__, #condition);      \
      std::abort();                                                                           \
    }                                                                                         \
  } while (false)
