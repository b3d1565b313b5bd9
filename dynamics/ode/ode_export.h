#pragma once

/// Marks what the shared library possibility_ode exports; everything else in it is hidden.
#define POSSIBILITY_ODE_API __attribute__((visibility("default")))
