#include "grammar.h"
#include <gtest/gtest.h>
