#pragma once

/// What the shared library possibility_ode shows; everything else in it is hidden.
#define POSSIBILITY_ODE_API __attribute__((visibility("default")))
