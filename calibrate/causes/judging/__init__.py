"""What evidences amount to: probabilities, chances by imagined studies, limits, the verdict."""
