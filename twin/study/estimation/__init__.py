"""Parameters, sensitivities, Kalman innovations, normal equations and the Gauss-Newton fit."""
