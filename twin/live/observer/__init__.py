"""The estimate: equations of motion, correction by measurements, prediction ahead."""
