"""The paper's own formulation (Rosales et al. 2011, equations 4-25), for comparison."""
