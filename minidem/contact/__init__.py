"""The words of contact models and the coefficients behind them."""
