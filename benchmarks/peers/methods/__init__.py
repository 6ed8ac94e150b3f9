"""The methods that are compared, each as it was meant."""
