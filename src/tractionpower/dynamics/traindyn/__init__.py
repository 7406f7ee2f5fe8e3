"""TrainDyn: trains as point masses in discrete-event simulations (Diviš and Kavička)."""
