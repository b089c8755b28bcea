EQUIVALENT="equivalent"
class Prover:
    def __init__(self,*a): pass
    def decide(self,c,k): return ["undecided",""]
